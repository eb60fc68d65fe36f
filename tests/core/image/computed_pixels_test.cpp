#include "core/image/computed_pixels.h"

#include <atomic>
#include <numeric>
#include <thread>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/file/scratch_file.h"
#include "core/image/pixel_buffer.h"

using namespace terrazzo;

namespace {

constexpr int many = 10000;

Digest some_digest() {
  static std::atomic<int> number{0};
  return Hasher().add("test").add(number++).digest();
}

ImageInfo gray(Size size) {
  return {.size = size, .channels = 1};
}

ImagePtr ramp(Size size) {
  std::vector<float> pixels(size_t(size.area()));
  for (size_t i = 0; i < pixels.size(); i++) pixels[i] = float(i * 37 % 101) / 101;
  return Image::from_floats(gray(size), std::move(pixels));
}

/// Counts the pixels that are computed of an image.
using Counter = std::shared_ptr<std::atomic<int64_t>>;

struct Counted {
  ImagePtr image;
  Counter pixels;
  double times() const { return double(*pixels) / double(image->size().area()); }
};

Counted counted(Operation operation, Size size) {
  const Counter pixels = std::make_shared<std::atomic<int64_t>>(0);
  operation.compute = [pixels, compute = std::move(operation.compute)](auto in, const Rect& region, float* out) {
    *pixels += region.area();
    compute(in, region, out);
  };
  return {Image::computed(gray(size), some_digest(), std::move(operation)), pixels};
}

float mixture(float a, float b, int step) {
  return 0.75f * a + 0.25f * b + float(step % 7) / 64 - 3.0f / 64;
}

/// A pixel of one image mixed with that of another.
Counted mixed(const ImagePtr& a, const ImagePtr& b, int step) {
  return counted({.sources = {a, b},
                  .compute =
                      [step](auto in, const Rect& region, float* out) {
                        const std::vector<float> p = in[0].read(region), q = in[1].read(region);
                        for (size_t i = 0; i < p.size(); i++) out[i] = mixture(p[i], q[i], step);
                      }},
                 a->size());
}

float mean_around(const float* above, const float* here, const float* below) {
  return (above[0] + here[-1] + here[0] + here[1] + below[0]) / 5;
}

/// The mean of a pixel and its four neighbours.
Counted smoothed(const ImagePtr& image, Outside outside) {
  const Size size = image->size();
  return counted({.sources = {image},
                  .reads = [=](size_t, const Rect& region) { return padded_parts(size, grown(region, 1), outside); },
                  .compute =
                      [=](auto in, const Rect& region, float* out) {
                        const std::vector<float> p = read_padded(in[0], grown(region, 1), outside);
                        const int row = region.width + 2;
                        for (int y = 1; y <= region.height; y++)
                          for (int x = 1; x <= region.width; x++) {
                            const float* here = &p[size_t(y * row + x)];
                            *out++ = mean_around(here - row, here, here + row);
                          }
                      },
                  .work = 5},
                 size);
}

Counted turned_over(const ImagePtr& image) {
  const Size size = image->size();
  const auto source = [size](const Rect& r) { return Rect{r.x, size.height - r.bottom(), r.width, r.height}; };
  return counted({.sources = {image},
                  .reads = [=](size_t, const Rect& region) { return std::vector<Rect>{source(region)}; },
                  .compute =
                      [=](auto in, const Rect& region, float* out) {
                        const std::vector<float> p = in[0].read(source(region));
                        for (int y = region.height; y-- > 0; out += region.width)
                          std::copy_n(&p[size_t(y) * size_t(region.width)], region.width, out);
                      }},
                 size);
}

// The same, straight away.

using Pixels = std::vector<float>;

Pixels plainly_mixed(const Pixels& a, const Pixels& b, int step) {
  Pixels out(a.size());
  for (size_t i = 0; i < a.size(); i++) out[i] = mixture(a[i], b[i], step);
  return out;
}

Pixels plainly_smoothed(const Pixels& in, Size size, Outside outside) {
  const auto at = [&](int x, int y) {
    if (outside == Outside::wrap) return in[size_t(wrap(y, size.height) * size.width + wrap(x, size.width))];
    return in[size_t(std::clamp(y, 0, size.height - 1) * size.width + std::clamp(x, 0, size.width - 1))];
  };
  Pixels out;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const float above = at(x, y - 1), below = at(x, y + 1);
      const float here[3] = {at(x - 1, y), at(x, y), at(x + 1, y)};
      out.push_back(mean_around(&above, here + 1, &below));
    }
  return out;
}

Pixels plainly_turned_over(const Pixels& in, Size size) {
  Pixels out;
  for (int y = size.height; y-- > 0;)
    out.insert(out.end(), in.begin() + ptrdiff_t{y} * size.width, in.begin() + ptrdiff_t{y + 1} * size.width);
  return out;
}

double most_times(const std::vector<Counted>& images) {
  double most = 0;
  for (const Counted& c : images) most = std::max(most, c.times());
  return most;
}

double mean_times(const std::vector<Counted>& images) {
  double sum = 0;
  for (const Counted& c : images) sum += c.times();
  return sum / double(images.size());
}

/// A graph of images that each are made from earlier ones, in ways that follow from a seed, beside their pixels.
struct Tangle {
  std::vector<Counted> images;
  Pixels expected;
  Tangle(Size size, int count, int reach, uint64_t seed) {
    std::vector<ImagePtr> all = {ramp(size)};
    std::vector<Pixels> plain = {all[0]->pixels()};
    for (int i = 0; i < count; i++) {
      const uint64_t r = random_bits(seed, i, 0);
      const size_t last = all.size() - 1, earlier = last - std::min<size_t>(last, (r >> 8) % uint64_t(reach));
      const Outside outside = r & 64 ? Outside::wrap : Outside::clamp;
      switch (r % 8) {
        case 0:
        case 1:
          images.push_back(smoothed(all[last], outside));
          plain.push_back(plainly_smoothed(plain[last], size, outside));
          break;
        case 2:
          images.push_back(turned_over(all[last]));
          plain.push_back(plainly_turned_over(plain[last], size));
          break;
        default:
          images.push_back(mixed(all[last], all[earlier], i));
          plain.push_back(plainly_mixed(plain[last], plain[earlier], i));
      }
      all.push_back(images.back().image);
    }
    expected = plain.back();
  }
};

}  // namespace

TEST_CASE("in a chain of 10,000 images, every one is computed once") {
  const Size size{16, 16};
  std::vector<Counted> images;
  ImagePtr image = ramp(size);
  Pixels expected = image->pixels();
  for (int i = 0; i < many; i++) {
    const Outside outside = i % 2 ? Outside::wrap : Outside::clamp;
    images.push_back(i % 3 ? smoothed(image, outside) : mixed(image, image, i));
    image = images.back().image;
    expected = i % 3 ? plainly_smoothed(expected, size, outside) : plainly_mixed(expected, expected, i);
  }
  CHECK(image->pixels() == expected);
  CHECK(most_times(images) == 1);
  CHECK(image->pixels() == expected);
  CHECK(mean_times(images) < 1.1);
}

TEST_CASE("in a chain of 10,000 diamonds, every image is computed once") {
  const Size size{16, 16};
  std::vector<Counted> images;
  ImagePtr image = ramp(size);
  Pixels expected = image->pixels();
  for (int i = 0; i < many; i++) {
    images.push_back(smoothed(image, Outside::wrap));
    images.push_back(mixed(image, images.back().image, i));
    image = images.back().image;
    expected = plainly_mixed(expected, plainly_smoothed(expected, size, Outside::wrap), i);
  }
  CHECK(image->pixels() == expected);
  CHECK(most_times(images) <= 2);
}

TEST_CASE("an image that 10,000 others read is computed a few times, whoever pulls them") {
  const Size size{16, 16};
  std::vector<Counted> before = {smoothed(ramp(size), Outside::clamp)};
  for (int i = 0; i < 20; i++) before.push_back(smoothed(before.back().image, Outside::clamp));
  const ImagePtr shared = before.back().image;
  std::vector<Counted> readers;
  for (int i = 0; i < many; i++) readers.push_back(mixed(shared, shared, i));
  Pixels expected = shared->pixels(), sum(expected.size());
  for (int i = 0; i < many; i++) {
    const Pixels own = plainly_mixed(expected, expected, i);
    if (i % 1000 == 0) CHECK(readers[size_t(i)].image->pixels() == own);
    for (size_t k = 0; k < sum.size(); k++) sum[k] += own[k];
  }
  Operation all{.sources = {}, .compute = [](auto in, const Rect& region, float* out) {
                  std::fill_n(out, region.area(), 0.0f);
                  for (const PixelView& view : in) {
                    const Pixels p = view.read(region);
                    for (size_t k = 0; k < p.size(); k++) out[k] += p[k];
                  }
                }};
  for (const Counted& reader : readers) all.sources.push_back(reader.image);
  const Counted fan = counted(std::move(all), size);
  CHECK(fan.image->pixels() == sum);
  CHECK(most_times(readers) <= 2);
  CHECK(most_times(before) <= 2);
}

TEST_CASE("images made from any earlier ones are computed a few times, and right") {
  const Tangle tangle({16, 16}, many, 40, 1);
  CHECK(tangle.images.back().image->pixels() == tangle.expected);
  CHECK(mean_times(tangle.images) < 6);
  CHECK(most_times(tangle.images) <= 3 * longest_pull());
}

TEST_CASE("computed images can be pulled by strips, from several threads") {
  const Size size{40, 500};
  const Tangle tangle(size, 300, 12, 2);
  const Image& image = *tangle.images.back().image;
  Pixels pulled(tangle.expected.size());
  std::atomic<int> next{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; t++)
    threads.emplace_back([&] {
      for (int y; (y = 20 * next++) < size.height;)
        image.read({0, y, size.width, std::min(20, size.height - y)}, &pulled[size_t(y) * size_t(size.width)]);
    });
  for (std::thread& t : threads) t.join();
  CHECK(pulled == tangle.expected);
  CHECK(mean_times(tangle.images) < 8);
}

TEST_CASE("images whose pixels have to be kept take no more memory than they may, and leave nothing behind") {
  const Size size{64, 600};
  const uint64_t limit = PixelBuffer::memory_limit(), in_use = PixelBuffer::memory_in_use();
  PixelBuffer::set_memory_limit(in_use + uint64_t(size.area()) * sizeof(float));
  uint64_t most_in_use = 0, most_on_disk = 0;
  {
    Tangle tangle(size, 400, 12, 3);
    const ImagePtr last = tangle.images.back().image;
    tangle.images.clear();
    Pixels pulled;
    for_each_strip(*last, [&](const Rect& r, const float* p) {
      most_in_use = std::max(most_in_use, PixelBuffer::memory_in_use());
      most_on_disk = std::max(most_on_disk, ScratchFile::shared().size());
      pulled.insert(pulled.end(), p, p + r.area());
    });
    CHECK(pulled == tangle.expected);
  }
  CHECK(most_in_use <= PixelBuffer::memory_limit());
  CHECK(most_on_disk > 0);
  CHECK(most_on_disk < 30 * uint64_t(size.area()) * sizeof(float));  // of 400 images
  CHECK(PixelBuffer::memory_in_use() == in_use);
  CHECK(ScratchFile::shared().size() == 0);
  PixelBuffer::set_memory_limit(limit);
}

TEST_CASE("a chain keeps the pixels of a few images only, and lets go of those that it is past") {
  const uint64_t in_use = PixelBuffer::memory_in_use();
  const Size size{64, 64};
  uint64_t most = 0;
  ImagePtr image = ramp(size);
  for (int i = 0; i < 1000; i++) {
    image = mixed(image, image, i).image;
    image = counted({.sources = {image},
                     .compute =
                         [&most](auto in, const Rect& region, float* out) {
                           most = std::max(most, PixelBuffer::memory_in_use());
                           in[0].read(region, out);
                         }},
                    size)
                .image;
  }
  image->pixels();
  CHECK(most - in_use <= 3 * uint64_t(size.area()) * sizeof(float));
}

TEST_CASE("cancelling stops a pull at once, and another goes on from there") {
  std::atomic<bool> cancelled{false};
  const Task task(&cancelled, {});
  const Size size{16, 300};
  int64_t computed = 0;
  ImagePtr image = ramp(size);
  Pixels expected = image->pixels();
  const auto step = [&](auto in, const Rect& region, float* out) {
    in[0].read(region, out);
    for (int64_t i = 0; i < region.area(); i++) out[i] += 1;
    computed++;
    if (computed == 777) cancelled = true;
  };
  for (int i = 0; i < 2000; i++) image = counted({.sources = {image}, .compute = step}, size).image;
  for (float& v : expected)
    for (int i = 0; i < 2000; i++) v += 1;
  std::thread([&] {  // alone in its arena or not: nobody else pulls
    const CurrentTask scope(task);
    CHECK_THROWS_AS(image->pixels(), Cancelled);
  })
      .join();
  CHECK(computed >= 777);
  CHECK(computed < 777 + 2 * longest_pull() * std::thread::hardware_concurrency());
  CHECK(image->pixels() == expected);
}

TEST_CASE("a thread that is cancelled leaves its part to those that are not") {
  std::atomic<bool> cancelled{false};
  const Task task(&cancelled, {});
  const Size size{16, 1 << 14};
  std::atomic<int> computed{0};
  ImagePtr image = ramp(size);
  Pixels expected = image->pixels();
  const auto step = [&](auto in, const Rect& region, float* out) {
    in[0].read(region, out);
    for (int64_t i = 0; i < region.area(); i++) out[i] *= 0.5f;
    if (++computed == 150) cancelled = true;
  };
  for (int i = 0; i < 100; i++) image = counted({.sources = {image}, .compute = step}, size).image;
  for (float& v : expected)
    for (int i = 0; i < 100; i++) v *= 0.5f;
  std::thread hurried([&] {
    const CurrentTask scope(task);
    try {
      image->pixels();
    } catch (const Cancelled&) {
    }
  });
  CHECK(image->pixels() == expected);
  hurried.join();
}

TEST_CASE("a failure while pixels are kept is told, and may be gone when they are asked for again") {
  std::atomic<bool> fails{true};
  const Size size{8, 200};
  ImagePtr image = ramp(size);
  const Pixels expected = image->pixels();
  for (int i = 0; i < 100; i++)
    image = counted({.sources = {image},
                     .compute =
                         [&, i](auto in, const Rect& region, float* out) {
                           if (i == 5 && fails) throw Error("the disk is gone");
                           in[0].read(region, out);
                         }},
                    size)
                .image;
  CHECK_THROWS_WITH_AS(image->pixels(), "the disk is gone", Error);
  fails = false;
  CHECK(image->pixels() == expected);
}

TEST_CASE("a hundred thousand images in a row go away") {
  ImagePtr image = ramp({2, 2});
  for (int i = 0; i < 100000; i++)
    image = Image::computed(
        gray({2, 2}), Digest(),
        {.sources = {image}, .compute = [](auto in, const Rect& r, float* out) { in[0].read(r, out); }});
  const std::weak_ptr<const Image> last = image;
  image.reset();
  CHECK(last.expired());
}

TEST_CASE("an operation that reads pixels it has not asked for is found out") {
  const ImagePtr first = Image::computed(
      gray({100, 100}), Digest(), [](const Rect& region, float* out) { std::iota(out, out + region.area(), 0.0f); });
  const ImagePtr image = Image::computed(gray({100, 100}), Digest(),
                                         {.sources = {first}, .compute = [](auto in, const Rect& r, float* out) {
                                            in[0].read({r.x, r.y + 1, r.width, r.height}, out);
                                          }});
  std::vector<float> out(100 * 10);
  CHECK_THROWS_AS(image->read({0, 10, 100, 10}, out.data()), std::logic_error);
}
