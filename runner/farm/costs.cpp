#include "runner/farm/costs.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace {

constexpr uint64_t most_bytes = 4096;

std::filesystem::path file_of(const std::filesystem::path& costs, const Digest& kind) {
  return costs / (kind.hex() + ".json");
}

}  // namespace

std::optional<UnitCost> cost_of(const std::filesystem::path& costs, const Digest& kind) {
  try {
    const auto json = nlohmann::json::parse(read_file(file_of(costs, kind), most_bytes));
    return UnitCost{json.at("seconds").get<double>(), json.at("cpu_seconds").get<double>(),
                    json.at("memory").get<uint64_t>()};
  } catch (const std::exception&) {
    return std::nullopt;  // missing or damaged
  }
}

void remember_cost(const std::filesystem::path& costs, const Digest& kind, UnitCost cost) {
  if (const std::optional<UnitCost> before = cost_of(costs, kind)) cost.memory = std::max(cost.memory, before->memory);
  const nlohmann::ordered_json json = {
      {"seconds", cost.seconds}, {"cpu_seconds", cost.cpu_seconds}, {"memory", cost.memory}};
  try {
    write_whole_file(file_of(costs, kind), json.dump() + "\n");
  } catch (const std::exception&) {
    // a full disk: later units fall back to estimates
  }
}

}  // namespace terrazzo
