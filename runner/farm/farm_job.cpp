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

/// Raised when a member is removed or changes its meaning.
constexpr int job_version = 2;

constexpr std::string_view digest_member = "digest";

std::string text_of(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The checksum of all other members.
std::string seal_of(const Json& json) {
  return Hasher().add("farm job").add(text_of(json)).digest().hex();
}

Json json_of_digests(const std::map<std::string, Digest>& digests) {
  Json json = Json::object();
  for (const auto& [name, digest] : digests) json[name] = digest.hex();
  return json;
}

Json json_of_unit(const Unit& u) {
  return {{"name", u.name},        {"nodes", u.nodes},     {"targets", u.targets}, {"needs", u.needs},
          {"wanted", u.is_wanted}, {"seconds", u.seconds}, {"kind", u.kind.hex()}};
}

Digest digest_in(const Json& json) {
  Digest d;
  if (!Digest::parse(json.get<std::string>(), d)) throw Error("not a digest");
  return d;
}

std::map<std::string, Digest> digests_in(const Json& json) {
  std::map<std::string, Digest> out;
  for (const auto& [name, digest] : json.items()) out.emplace(name, digest_in(digest));
  return out;
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

/// The original of an input file; `file` is below FarmFolder::inputs.
std::string original_of(const FarmJob& job, const fs::path& file) {
  const fs::path copies = *file.begin();
  const auto origin = job.origins.find(copies.string());
  return origin == job.origins.end() ? "a file" : (fs::path(origin->second) / file.lexically_relative(copies)).string();
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

bool write_farm_job(const FarmJob& job, const fs::path& folder) {
  Json units = Json::array();
  for (const Unit& u : job.units) units.push_back(json_of_unit(u));
  Json json = {{"format", job_version},
               {"name", job.name},
               {"graph", job.graph},
               {"program", job.program},
               {"targets", job.targets},
               {"variables", job.variables},
               {"plugins", job.plugins},
               {"units", units},
               {"document", job.document.hex()},
               {"inputs", json_of_digests(job.inputs)},
               {"keys", json_of_digests(job.keys)},
               {"origins", job.origins},
               {"left_out", job.left_out}};
  json[digest_member] = seal_of(json);
  return write_if_other(folder / "job.json", text_of(json));
}

FarmJob read_farm_job(const fs::path& folder) {
  const fs::path file = folder / "job.json";
  try {
    const std::string text = read_file(file);
    Json json = Json::parse(text);
    if (const int format = json.at("format").get<int>(); format != job_version)
      throw Error(fmt::format("format {}; this version of terrazzo reads {}", format, job_version));
    const std::string digest = json.at(digest_member).get<std::string>();
    json.erase(digest_member);
    if (digest != seal_of(json)) throw Error("it does not have the digest that it had when it was written");
    FarmJob job;
    json.at("name").get_to(job.name);
    json.at("graph").get_to(job.graph);
    json.at("program").get_to(job.program);
    json.at("targets").get_to(job.targets);
    json.at("variables").get_to(job.variables);
    json.at("plugins").get_to(job.plugins);
    for (const Json& u : json.at("units")) job.units.push_back(unit_in(u));
    job.document = digest_in(json.at("document"));
    job.inputs = digests_in(json.at("inputs"));
    job.keys = digests_in(json.at("keys"));
    json.at("origins").get_to(job.origins);
    json.at("left_out").get_to(job.left_out);
    return job;
  } catch (const std::exception& e) {
    throw DamagedJob(
        fmt::format("{} is not a job of terrazzo, or has been altered or damaged: {}", file.string(), e.what()));
  }
}

void check_inputs(const FarmJob& job, const GraphNode& node, const fs::path& folder) {
  const fs::path inputs = FarmFolder::of_job(folder).inputs();
  for (const auto& [name, value] : node.params) {
    const Param* param = node.type->find_param(name);
    if (!param || param->type != ParamType::path) continue;
    const fs::path place = place_under(inputs, std::get<std::string>(value));
    if (place.empty()) continue;
    const std::string copies = place.begin()->string();
    const auto refuse = [&](const std::string& file, std::string_view what) {
      throw DamagedJob(fmt::format("farm/inputs/{}, the job's copy of {}, {}", file, original_of(job, file), what));
    };
    for (auto at = job.inputs.lower_bound(copies + "/"); at != job.inputs.end(); ++at) {
      if (!at->first.starts_with(copies + "/")) break;
      const std::optional<Digest> content = content_digest(inputs / at->first);
      if (!content) refuse(at->first, "has been lost or cannot be read");
      if (*content != at->second) refuse(at->first, "has been altered or damaged");
    }
    const auto is_known = [&](const fs::path& f) {
      return job.inputs.contains(place_under(inputs, f).generic_string());
    };
    for (const fs::path& stranger : strangers_in(inputs / copies, is_known))
      throw DamagedJob(fmt::format("farm/inputs/{} is in the folder of the job's inputs, but is not one of them",
                                   place_under(inputs, stranger).string()));
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
