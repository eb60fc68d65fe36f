#include "runner/farm/assignment.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "runner/farm/farm_folder.h"

namespace terrazzo {

namespace {

constexpr std::array<std::string_view, 3> names = {"slurm", "others", "nobody"};

std::filesystem::path file_of(const std::filesystem::path& folder) {
  return folder / "assignment.json";
}

}  // namespace

Assignment assignment_of(const std::filesystem::path& folder) {
  constexpr uint64_t most_bytes = uint64_t{1} << 16;
  std::error_code missing;
  if (!std::filesystem::exists(file_of(folder), missing)) return {};
  try {
    const auto json = nlohmann::json::parse(read_file(file_of(folder), most_bytes));
    const auto name = std::ranges::find(names, json.at("to").get<std::string>());
    if (name == names.end()) throw Error("\"to\" is something else");
    return {Assignment::To(name - names.begin()), json.at("file").get<std::string>()};
  } catch (const std::exception& e) {
    throw DamagedJob(fmt::format("{} does not say who is to make the job: {}", file_of(folder).string(), e.what()));
  }
}

void write_assignment(const std::filesystem::path& folder, const Assignment& assignment) {
  const nlohmann::ordered_json json = {{"to", names[size_t(assignment.to)]}, {"file", assignment.file}};
  write_whole_file(file_of(folder), json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace terrazzo
