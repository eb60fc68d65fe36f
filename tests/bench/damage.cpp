// What is told of damaged image files; tests/bench/damage.sh builds and starts this.
// Arguments: image files, and first a folder for damaged copies.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/image_io/image_file.h"

using namespace terrazzo;
namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<char>;

Bytes bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write(const fs::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

struct Outcome {
  bool at_once = false;  ///< refused before anything is decoded
  bool told = false;     ///< refused then or later, or warned of
  std::vector<float> pixels{};
};

/// Of all layers one after another.
std::vector<float> pixels_of(const fs::path& path, const std::function<void(const std::string&)>& warn) {
  std::vector<float> out;
  for (const FileInfo& layer : read_layer_infos(path)) {
    const std::vector<float> pixels = read_image(path, {}, warn, layer.layer)->pixels();
    out.insert(out.end(), pixels.begin(), pixels.end());
  }
  return out;
}

Outcome outcome_of(const fs::path& path, const std::set<std::string>& expected) {
  Outcome out{.at_once = true, .told = true};
  try {
    require_readable_image(path);
    (void)read_layer_infos(path);
    out.at_once = out.told = false;
    out.pixels = pixels_of(path, [&](const std::string& w) { out.told |= !expected.contains(w); });
  } catch (const Error&) {
    out.told = true;
  }
  return out;
}

struct Counts {
  int all = 0, at_once = 0, told = 0, harmless = 0;
  void add(const Outcome& outcome, const std::vector<float>& right) {
    all++;
    at_once += outcome.at_once;
    told += outcome.told;
    harmless += !outcome.told && outcome.pixels == right;
  }
  int silent() const { return all - told - harmless; }
};

class Damage {
 public:
  Damage(fs::path file, const fs::path& folder) : copy_(folder / file.filename()), whole_(bytes_of(file)) {
    write(copy_, whole_);
    right_ = pixels_of(copy_, [&](const std::string& w) { expected_.insert(w); });
  }
  /// One byte altered, at places spread over what is neither header nor, in most formats, tables at the end.
  Counts flipped(int places) {
    constexpr double first = 0.08, last = 0.95;
    Counts counts;
    for (int i = 0; i < places; i++) {
      const double part = first + (last - first) * (i + double(random_bits(1, i) & 1023) / 1024) / places;
      Bytes altered = whole_;
      altered[size_t(part * double(whole_.size()))] ^= char(1 + random_bits(2, i) % 255);
      write(copy_, altered);
      counts.add(outcome_of(copy_, expected_), right_);
    }
    return counts;
  }
  Counts cut() {
    Counts counts;
    std::vector<size_t> lengths;
    for (const size_t missing : {1, 4, 16, 64, 256})
      lengths.push_back(whole_.size() - std::min(missing, whole_.size()));
    for (size_t i = 1; i < 12; i++) lengths.push_back(whole_.size() * i / 12);
    for (const size_t length : lengths) {
      write(copy_, Bytes(whole_.begin(), whole_.begin() + std::ptrdiff_t(length)));
      counts.add(outcome_of(copy_, expected_), right_);
    }
    return counts;
  }

 private:
  fs::path copy_;
  Bytes whole_;
  std::set<std::string> expected_;
  std::vector<float> right_;
};

}  // namespace

int main(int argc, char** argv) try {
  constexpr int places = 32;
  if (argc < 3) {
    fmt::print(stderr, "usage: terrazzo_damage FOLDER FILE...\n");
    return 2;
  }
  fmt::print("| file | altered: told | harmless | silent | cut: told at once | told | harmless | silent |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (int i = 2; i < argc; i++) {
    Damage damage(argv[i], argv[1]);
    const Counts altered = damage.flipped(places), cut = damage.cut();
    fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} |\n", fs::path(argv[i]).filename().string(), altered.told,
               altered.harmless, altered.silent(), cut.at_once, cut.told, cut.harmless, cut.silent());
  }
  return 0;
} catch (const std::exception& e) {
  fmt::print(stderr, "{}\n", e.what());
  return 1;
}
