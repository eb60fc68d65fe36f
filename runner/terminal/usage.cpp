#include "runner/terminal/usage.h"

#include <array>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/file/atomic_file.h"
#include "runner/cache/cache_limit.h"

namespace terrazzo {

void check_writable(const char* option, const std::string& path) {
  if (path.empty()) return;
  const std::filesystem::path file = path;
  std::error_code missing;
  if (std::filesystem::exists(file, missing) && !std::filesystem::is_regular_file(file, missing) &&
      !std::filesystem::is_directory(file, missing))
    return;  // a device or a pipe
  const std::string trouble = why_not_writable(file.parent_path(), file.filename().string());
  if (!trouble.empty()) throw UsageError(fmt::format("{} {}: {}", option, path, trouble));
  if (std::filesystem::exists(file, missing) && !std::ofstream(file, std::ios::app))
    throw UsageError(fmt::format("{} {}: the file cannot be written", option, path));
}

uint64_t parse_bytes(const std::string& text, const std::string& option) {
  if (const std::optional<uint64_t> bytes = size_from(text)) return *bytes;
  throw UsageError(fmt::format("{} {}; \"{}\" is not one", option, size_help, text));
}

std::string shown_bytes(uint64_t bytes) {
  constexpr std::array<std::string_view, 5> units = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  if (bytes < 1024) return counted(int64_t(bytes), "byte");
  double value = static_cast<double>(bytes);
  size_t unit = 0;
  for (; value >= 1024 && unit + 1 < units.size(); unit++) value /= 1024;
  return fmt::format("{:.1f} {}", value, units[unit]);
}

}  // namespace terrazzo
