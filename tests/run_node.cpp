#include "tests/run_node.h"

#include <algorithm>
#include <atomic>
#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"
#include "nodes/common/registry.h"

namespace terrazzo::test {

NodeRun run_node(const std::string& type_name, const Params& params,
                 const std::map<std::string, std::vector<Value>>& inputs) {
  const NodeType* type = find_node_type(type_name);
  REQUIRE_MESSAGE(type, type_name);
  Params all;
  for (const Param& p : type->params) {
    const auto given = params.find(p.name);
    REQUIRE_MESSAGE((given != params.end() || p.fallback), p.name);
    all[p.name] = given != params.end() ? given->second : *p.fallback;
  }
  for (const auto& [name, value] : params) REQUIRE_MESSAGE(type->find_param(name), name);
  std::map<std::string, std::vector<Value>> values;
  for (const auto& [name, list] : inputs) {
    const Port* port = type->find_input(name);
    REQUIRE_MESSAGE(port, name);
    for (const Value& v : list) {
      REQUIRE_MESSAGE(converts(type_of(v), port->type), name);
      values[name].push_back(converted(v, port->type));
    }
  }
  for (const Port& p : type->inputs)
    if (!p.optional) REQUIRE_MESSAGE(!values[p.name].empty(), p.name);

  Hasher key;
  key.add(type->name);
  add_to(key, all);
  for (const auto& [name, list] : values)
    for (const Value& v : list) key.add(name).add(digest_of(v));
  NodeContext context(*type, all, values, key.digest(), Task());
  try {
    context.compute();
  } catch (...) {
    for (const StagedFile& f : context.staged()) std::filesystem::remove(f.temporary);
    throw;
  }
  for (const StagedFile& f : context.staged()) std::filesystem::rename(f.temporary, f.target);
  for (const Port& p : type->outputs) REQUIRE_MESSAGE(context.outputs().count(p.name), p.name);
  for (const auto& [port, forecast] : context.inferred()) {
    REQUIRE_MESSAGE(context.outputs().count(port), port);
    CHECK_MESSAGE(contradiction(forecast, context.outputs().at(port)) == "", type_name << "." << port);
  }
  return {context.outputs(), context.notes()};
}

bool NodeRun::says(const std::string& text) const {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& n) { return n.find(text) != n.npos; });
}

std::string error_of(const std::string& type, const Params& params,
                     const std::map<std::string, std::vector<Value>>& inputs) {
  try {
    run_node(type, params, inputs);
  } catch (const Error& e) {
    return e.about() + ": " + e.what();
  }
  return "";
}

ImagePtr make_image(Size size, int channels, const std::function<float(int, int, int)>& value, Semantic semantic,
                    const std::string& color_space) {
  std::vector<float> pixels;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      for (int c = 0; c < channels; c++) pixels.push_back(value(x, y, c));
  ImageInfo info{.size = size, .channels = channels, .semantic = semantic, .color_space = color_space};
  return Image::from_floats(info, std::move(pixels));
}

TemporaryFolder::TemporaryFolder() {
  static std::atomic<int> count{0};
  path_ = std::filesystem::temp_directory_path() / fmt::format("terrazzo-test-{}-{}", ::getpid(), count++);
  std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace terrazzo::test
