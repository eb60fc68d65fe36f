#include "runner/scheduler/openjd.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

/// The specification's limit for the names of steps.
constexpr size_t longest_name = 64;

std::string step_name(size_t index, const std::string& label) {
  return fmt::format("{} {}", index + 1, label).substr(0, longest_name);
}

Json step_of(const std::vector<TaskArray>& arrays, size_t index) {
  const TaskArray& array = arrays[index];
  const Json arguments = {"task", "{{Param.JobFolder}}", "--array", array.id().hex(), "--index", "{{Task.Param.Task}}"};
  Json step = {{"name", step_name(index, array.label)}};
  if (!array.needs.empty()) {
    Json needs = Json::array();
    for (const size_t n : array.needs) needs.push_back({{"dependsOn", step_name(n, arrays[n].label)}});
    step["dependencies"] = needs;
  }
  const auto at_least = [](const char* what, uint64_t amount) { return Json{{"name", what}, {"min", amount}}; };
  step["hostRequirements"] = {{"amounts", Json::array({at_least("amount.worker.vcpu", uint64_t(array.cores)),
                                                       at_least("amount.worker.memory", array.memory >> 20)})}};
  step["parameterSpace"] = {
      {"taskParameterDefinitions",
       Json::array({{{"name", "Task"}, {"type", "INT"}, {"range", fmt::format("0-{}", array.tasks.size() - 1)}}})}};
  step["script"] = {{"actions", {{"onRun", {{"command", "{{Param.Program}}"}, {"args", arguments}}}}}};
  return step;
}

}  // namespace

std::string openjd_template(const FarmJob& job, const std::vector<TaskArray>& arrays,
                            const std::filesystem::path& folder, const std::filesystem::path& program) {
  Json steps = Json::array();
  for (size_t i = 0; i < arrays.size(); i++) steps.push_back(step_of(arrays, i));
  const Json parameters = Json::array({{{"name", "JobFolder"},
                                        {"type", "PATH"},
                                        {"objectType", "DIRECTORY"},
                                        {"dataFlow", "INOUT"},
                                        {"default", folder.string()},
                                        {"description", "The frozen job, on a file system that all workers share"}},
                                       {{"name", "Program"},
                                        {"type", "STRING"},
                                        {"default", program.string()},
                                        {"description", "The program terrazzo on the workers"}}});
  const Json json = {{"specificationVersion", "jobtemplate-2023-09"},
                     {"name", job.name},
                     {"description", fmt::format("{}, frozen by {}", job.graph, job.program)},
                     {"parameterDefinitions", parameters},
                     {"steps", steps}};
  return json.dump(2) + "\n";
}

}  // namespace terrazzo
