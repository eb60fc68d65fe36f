#include "runner/farm/farm_job.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "runner/farm/farm_folder.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Raised when a member goes, or comes to mean something else.
constexpr int format_version = 1;

Json json_of_unit(const Unit& u) {
  return {{"name", u.name},        {"nodes", u.nodes},     {"targets", u.targets}, {"needs", u.needs},
          {"wanted", u.is_wanted}, {"seconds", u.seconds}, {"kind", u.kind.hex()}};
}

Digest digest_in(const Json& json) {
  Digest d;
  if (!Digest::parse(json.get<std::string>(), d)) throw Error("not a digest");
  return d;
}

Unit unit_in(const Json& json) {
  Unit u;
  json.at("name").get_to(u.name);
  json.at("nodes").get_to(u.nodes);
  json.at("targets").get_to(u.targets);
  json.at("needs").get_to(u.needs);
  json.at("wanted").get_to(u.is_wanted);
  json.at("seconds").get_to(u.seconds);
  u.kind = digest_in(json.at("kind"));
  return u;
}

fs::path failure_file(const fs::path& folder, const std::string& unit) {
  return folder / "failures" / (unit + ".json");
}

}  // namespace

const Unit* FarmJob::find(std::string_view unit) const {
  const auto at = std::ranges::find(units, unit, &Unit::name);
  return at == units.end() ? nullptr : &*at;
}

std::string job_name(const fs::path& graph, const Digest& id) {
  std::string stem = graph.stem().string();
  std::erase_if(stem, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_'; });
  return fmt::format("{}-{}", stem.empty() ? "graph" : stem.substr(0, 40), id.hex().substr(0, 12));
}

void write_farm_job(const FarmJob& job, const fs::path& folder) {
  Json units = Json::array(), keys = Json::object();
  for (const Unit& u : job.units) units.push_back(json_of_unit(u));
  for (const auto& [node, key] : job.keys) keys[node] = key.hex();
  const Json json = {{"format", format_version}, {"name", job.name},        {"graph", job.graph},
                     {"program", job.program},   {"targets", job.targets},  {"variables", job.variables},
                     {"plugins", job.plugins},   {"units", units},          {"keys", keys},
                     {"origins", job.origins},   {"left_out", job.left_out}};
  write_whole_file(folder / "job.json", json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

FarmJob read_farm_job(const fs::path& folder) {
  const fs::path file = folder / "job.json";
  const std::string text = read_file(file);
  try {
    const Json json = Json::parse(text);
    if (const int format = json.at("format").get<int>(); format != format_version)
      throw Error(fmt::format("format {}; this version of terrazzo reads {}", format, format_version));
    FarmJob job;
    json.at("name").get_to(job.name);
    json.at("graph").get_to(job.graph);
    json.at("program").get_to(job.program);
    json.at("targets").get_to(job.targets);
    json.at("variables").get_to(job.variables);
    json.at("plugins").get_to(job.plugins);
    for (const Json& u : json.at("units")) job.units.push_back(unit_in(u));
    for (const auto& [node, key] : json.at("keys").items()) job.keys.emplace(node, digest_in(key));
    // The first version did not write these.
    job.origins = json.value("origins", job.origins);
    job.left_out = json.value("left_out", job.left_out);
    return job;
  } catch (const std::exception& e) {
    throw Error(fmt::format("{} is no job of terrazzo, or damaged: {}; remove its folder and submit again",
                            file.string(), e.what()));
  }
}

std::string with_original_names(std::string message, const FarmJob& job, const fs::path& folder) {
  const fs::path inputs = FarmFolder::of_job(folder).inputs();
  bool is_about_a_copy = false;
  for (const auto& [copies, origin] : job.origins) {
    const std::string from = (inputs / copies).string();
    for (size_t at = message.find(from); at != message.npos; at = message.find(from, at + origin.size())) {
      message.replace(at, from.size(), origin);
      is_about_a_copy = true;
    }
  }
  if (is_about_a_copy) message += fmt::format(" (as it was when it was submitted; copies are in {})", inputs.string());
  return message;
}

std::optional<UnitFailure> failure_of(const fs::path& folder, const std::string& unit) {
  constexpr uint64_t most_bytes = uint64_t{1} << 20;
  try {
    const Json json = Json::parse(read_file(failure_file(folder, unit), most_bytes));
    return UnitFailure{json.at("message").get<std::string>(), json.at("memory").get<uint64_t>()};
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void write_failure(const fs::path& folder, const std::string& unit, const UnitFailure& failure) {
  const Json json = {{"message", failure.message}, {"memory", failure.memory}};
  write_whole_file(failure_file(folder, unit), json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

void forget_failure(const fs::path& folder, const std::string& unit) {
  std::error_code missing;
  fs::remove(failure_file(folder, unit), missing);
}

}  // namespace terrazzo
