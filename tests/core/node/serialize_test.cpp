#include "core/node/serialize.h"

#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>

#include <doctest/doctest.h>
#include <tbb/parallel_for.h>

#include "core/file/file_io.h"
#include "tests/run_node.h"
#include "tests/sample_values.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Value round_trip(const Value& value, const std::filesystem::path& path) {
  save_value(value, path, Task());
  return load_value(path);
}

ImagePtr image_of(const std::vector<float>& pixels, Depth depth = Depth::f32) {
  return Image::from_floats({.size = {int(pixels.size()), 1}, .channels = 1, .depth = depth}, pixels);
}

/// Noise that no compression makes small: the file is too large to be held in memory.
ImagePtr large_image() {
  return sample_image({900, 700});
}

}  // namespace

TEST_CASE("every type of value comes back from its file with the same content and digest") {
  const TemporaryFolder folder;
  for (const Value& value : sample_values()) {
    CAPTURE(name_of(type_of(value)));
    const std::filesystem::path path = folder.path() / "value";
    CHECK(same_content(round_trip(value, path), value));
    const ValueFileSummary summary = summarize_value_file(path);
    CHECK(summary.type == type_of(value));
    CHECK(summary.digest == digest_of(value));
  }
}

TEST_CASE("the same value gives the same file, and the seconds are kept beside it") {
  const TemporaryFolder folder;
  for (const Value& value : sample_values()) {
    save_value(value, folder.path() / "a", Task(), 2.5);
    save_value(value, folder.path() / "b", Task(), 2.5);
    CHECK(read_text(folder.path() / "a") == read_text(folder.path() / "b"));
    CHECK(summarize_value_file(folder.path() / "a").seconds == 2.5);
  }
}

TEST_CASE("pixels survive bit by bit, whatever they are") {
  const TemporaryFolder folder;
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> u8_divided, u8_scaled, u16_divided, u16_scaled;
  for (int i = 0; i < 256; i++) {
    u8_divided.push_back(float(i) / 255.0f);
    u8_scaled.push_back(float(i) * (1.0f / 255.0f));
  }
  for (int i = 0; i < 65536; i++) {
    u16_divided.push_back(float(i) / 65535.0f);
    u16_scaled.push_back(float(i) * (1.0f / 65535.0f));
  }
  const std::vector<std::vector<float>> all = {
      u8_divided,    u8_scaled,      u16_divided, u16_scaled, {0.5f, 1024, -0.125f},
      {-0.0f, 0.0f}, {inf, -inf, 1}, {nan, -nan}, {-1, 0, 2}, {0.1f, 1e30f, 1e-40f}};
  for (const std::vector<float>& pixels : all) {
    const ImagePtr image = image_of(pixels);
    CHECK(same_content(round_trip(image, folder.path() / "image"), image));
  }
}

TEST_CASE("pixels that came from 8-bit files take a byte per sample, half floats two") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "image";
  const ImagePtr noise = sample_image({64, 64});
  save_value(noise, path, Task());
  CHECK(std::filesystem::file_size(path) < 64 * 64 * 3 + 500);
  std::vector<float> halves;
  for (const float v : noise->pixels()) halves.push_back(std::round(v * 255) * 4 - 300);
  save_value(image_of(halves), path, Task());
  CHECK(std::filesystem::file_size(path) < 64 * 64 * 3 * 2 + 500);
}

TEST_CASE("an image computed on demand becomes stored pixels under the same digest") {
  const TemporaryFolder folder;
  const ImageInfo info{.size = {1000, 700}, .channels = 2};
  const ImagePtr computed = Image::computed(info, Digest{1, 2}, [](const Rect& r, float* out) {
    for (int y = r.y; y < r.bottom(); y++)
      for (int x = r.x; x < r.right(); x++) {
        *out++ = float(x * 1000 + y);
        *out++ = 1.0f / float(y + 1);
      }
  });
  CHECK(same_content(round_trip(computed, folder.path() / "image"), computed));
}

TEST_CASE("regions of a stored image equal those of the original, from many threads, after the file is removed") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "image";
  const ImagePtr image = large_image();
  const Value value = round_trip(image, path);
  const ImagePtr stored = std::get<ImagePtr>(value);
  REQUIRE(std::filesystem::file_size(path) > (1 << 20));
  std::filesystem::remove(path);
  std::atomic<int> wrong{0};
  tbb::parallel_for(0, 200, [&](int i) {
    const int x = int(random_bits(1, i) % 900), y = int(random_bits(2, i) % 700);
    const Rect r{x, y, std::min(900 - x, 130), std::min(700 - y, 50)};
    if (stored->read(r) != image->read(r)) wrong++;
  });
  CHECK(wrong == 0);
  CHECK(same_content(value, image));
}

TEST_CASE("damage done to a file after it was opened is found by the pull that meets it") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "image";
  const ImagePtr stored = std::get<ImagePtr>(round_trip(large_image(), path));
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(-1000, std::ios::end);
  file << "damaged";
  file.close();
  CHECK(stored->read({0, 0, 900, 10}) == large_image()->read({0, 0, 900, 10}));
  CHECK_THROWS_WITH_AS(stored->pixels(), doctest::Contains("checksum"), DamagedFile);
  std::filesystem::resize_file(path, 100);
  CHECK_THROWS_WITH_AS(stored->read({0, 699, 900, 1}), doctest::Contains("ends too early"), DamagedFile);
}

TEST_CASE("a truncated value file is an error at every length") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "value";
  for (const Value& value : sample_values()) {
    save_value(value, path, Task());
    const std::string bytes = read_text(path);
    for (size_t size = 0; size < bytes.size(); size++) {
      replace_text(path, bytes.substr(0, size));
      REQUIRE_THROWS_AS(load_value(path), DamagedFile);
    }
    replace_text(path, bytes + '\0');
    CHECK_THROWS_AS(load_value(path), DamagedFile);
  }
}

TEST_CASE("a value file with any one bit flipped is an error") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "value";
  save_value(Material::make("m", {{"base_color", sample_image({4, 3})}}), path, Task());
  std::string bytes = read_text(path);
  for (size_t bit = 0; bit < bytes.size() * 8; bit++) {
    bytes[bit / 8] ^= char(1 << bit % 8);
    replace_text(path, bytes);
    REQUIRE_THROWS_AS(load_value(path), DamagedFile);
    bytes[bit / 8] ^= char(1 << bit % 8);
  }
}

TEST_CASE("random garbage is an error, with and without the right beginning") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "value";
  save_value(sample_values()[4], path, Task());
  const std::string good = read_text(path);
  for (int round = 0; round < 200; round++) {
    std::string bytes;
    const size_t size = random_bits(1, round) % 600;
    for (size_t i = 0; i < size; i++) bytes += char(random_bits(2, round, i));
    replace_text(path, bytes);
    REQUIRE_THROWS_AS(load_value(path), DamagedFile);
    replace_text(path, good.substr(0, 72) + bytes);
    REQUIRE_THROWS_AS(load_value(path), DamagedFile);
  }
}

TEST_CASE("messages say what is wrong with a file") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "value";
  replace_text(path, "not a value at all");
  CHECK_THROWS_WITH_AS(load_value(path), doctest::Contains("not a terrazzo value file"), DamagedFile);
  save_value(sample_values()[0], path, Task());
  std::string bytes = read_text(path);
  bytes[8] = 9;
  replace_text(path, bytes);
  CHECK_THROWS_WITH_AS(load_value(path), doctest::Contains("format version is 9"), DamagedFile);
  CHECK_THROWS_WITH_AS(load_value(path), doctest::Contains(path.c_str()), DamagedFile);
  CHECK_THROWS_WITH_AS(load_value(folder.path() / "none"), doctest::Contains("No such file"), FileError);
  CHECK_THROWS_AS(load_value(folder.path()), Error);
}

TEST_CASE("a value that cannot be written is a clear error and leaves no file") {
  const TemporaryFolder folder;
  const Value value = large_image();
  CHECK_THROWS_WITH_AS(save_value(value, folder.path() / "none" / "value", Task()), doctest::Contains("No such file"),
                       FileError);
  if (std::filesystem::exists("/dev/full"))
    CHECK_THROWS_WITH_AS(save_value(value, "/dev/full", Task()), doctest::Contains("No space left"), FileError);
  const ImagePtr failing = Image::computed({.size = {9, 9}, .channels = 1}, Digest{},
                                           [](const Rect&, float*) { throw Error("its source is gone"); });
  CHECK_THROWS_WITH_AS(save_value(failing, folder.path() / "value", Task()), "its source is gone", Error);
  const std::atomic<bool> cancelled{true};
  CHECK_THROWS_AS(save_value(value, folder.path() / "value", Task(&cancelled, nullptr)), Cancelled);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("saving reports how far it is") {
  const TemporaryFolder folder;
  double last = 0;
  save_value(large_image(), folder.path() / "value", Task(nullptr, [&last](double f) {
               CHECK(f >= last);
               last = f;
             }));
  CHECK(last == 1);
}
