#include "runner/cache/cache_limit.h"

#include <cctype>
#include <charconv>
#include <fstream>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/file/user_folders.h"

namespace terrazzo {

namespace {

constexpr uint64_t default_limit = uint64_t{10} << 30;
constexpr const char* variable = "TERRAZZO_CACHE_SIZE";

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// The value of `size` in a file of lines NAME = VALUE, where # begins a comment.
std::optional<uint64_t> size_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::optional<uint64_t> size;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    number++;
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const size_t sign = line.find('=');
    const std::string name = trimmed(line.substr(0, sign)),
                      value = sign < line.size() ? trimmed(line.substr(sign + 1)) : "";
    if (name != "size")
      throw Error(fmt::format("{}:{}: unknown setting \"{}\"{}; a cache has the setting size, as in `size = 20G`",
                              file.string(), number, name, did_you_mean(name, {"size"})));
    size = size_from(value);
    if (!size) throw Error(fmt::format("{}:{}: size {}; \"{}\" is not one", file.string(), number, size_help, value));
  }
  return size;
}

}  // namespace

std::optional<uint64_t> size_from(std::string_view text) {
  double number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  std::string unit(end, text.data() + text.size());
  std::erase(unit, ' ');
  for (const std::string_view ending : {"iB", "B"})
    if (unit.size() > 1 && unit.ends_with(ending)) unit.erase(unit.size() - ending.size());
  const size_t power = unit.size() == 1 ? std::string_view("KMGT").find(static_cast<char>(std::toupper(unit[0])))
                                        : std::string_view::npos;
  if (failure != std::errc() || power == std::string_view::npos || !(number > 0) || number > 1e6) return std::nullopt;
  return static_cast<uint64_t>(number * static_cast<double>(uint64_t{1} << (10 * (power + 1))));
}

CacheLimit cache_limit(const std::filesystem::path& folder) {
  if (const std::string text = environment(variable); !text.empty()) {
    if (const std::optional<uint64_t> size = size_from(text)) return {*size, variable};
    throw Error(fmt::format("{} {}; \"{}\" is not one", variable, size_help, text));
  }
  const std::filesystem::path settings = folder / "settings.txt";
  if (const std::optional<uint64_t> size = size_in(settings)) return {*size, settings.string()};
  return {default_limit, "the default"};
}

}  // namespace terrazzo
