#include "runner/cache/history_files.h"

#include <array>

#include <fmt/format.h>
#include <xxhash.h>

#include "core/block_file/bytes.h"

namespace terrazzo {

namespace {

constexpr std::string_view any_version = "terrazzo history ", version = "terrazzo history 3\n";
constexpr std::array<std::string_view, 2> versions_without_checksum = {"terrazzo history 1\n", "terrazzo history 2\n"};

std::string last_line(std::string_view above) {
  return fmt::format("checksum\t{:016x}\n", XXH3_64bits(above.data(), above.size()));
}

}  // namespace

std::string sealed_history(std::string_view lines) {
  std::string text = std::string(version) + std::string(lines);
  return text + last_line(text);
}

std::optional<std::string> unsealed_history(std::string_view bytes) {
  for (const std::string_view old : versions_without_checksum)
    if (bytes.starts_with(old)) return std::string(bytes.substr(old.size()));
  if (!bytes.starts_with(any_version)) throw DamagedFile("it is of another format");
  if (!bytes.starts_with(version)) return std::nullopt;
  const size_t seal = last_line("").size();
  if (bytes.size() < version.size() + seal) throw DamagedFile("it ends too early");
  const std::string_view above = bytes.substr(0, bytes.size() - seal);
  if (bytes.substr(above.size()) != last_line(above)) throw DamagedFile("its checksum is wrong");
  return std::string(above.substr(version.size()));
}

}  // namespace terrazzo
