#include "core/node/node.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/file/atomic_file.h"
#include "core/file/write_guard.h"

namespace terrazzo {

ParamValue::ParamValue(const ParamValue& other) = default;
ParamValue::ParamValue(ParamValue&& other) noexcept = default;
ParamValue& ParamValue::operator=(const ParamValue& other) = default;
ParamValue& ParamValue::operator=(ParamValue&& other) noexcept = default;
ParamValue::~ParamValue() = default;

std::string_view name_of(ParamType type) {
  constexpr std::array<std::string_view, 11> names = {"boolean", "integer",    "number",   "text",   "size", "numbers",
                                                      "texts",   "number_map", "text_map", "choice", "path"};
  return names[static_cast<size_t>(type)];
}

namespace {

struct AddParam {
  Hasher& h;
  void operator()(bool v) const { h.add(v); }
  void operator()(int64_t v) const { h.add(v); }
  void operator()(double v) const { h.add(v); }
  void operator()(const std::string& v) const { h.add(v); }
  void operator()(Size v) const { h.add(v.width).add(v.height); }
  void operator()(const Numbers& v) const {
    h.add(int64_t(v.size()));
    for (const double d : v) h.add(d);
  }
  void operator()(const Texts& v) const {
    h.add(int64_t(v.size()));
    for (const std::string& s : v) h.add(s);
  }
  void operator()(const NumberMap& v) const {
    h.add(int64_t(v.size()));
    for (const auto& [name, numbers] : v) {
      h.add(name);
      (*this)(numbers);
    }
  }
  void operator()(const TextMap& v) const {
    h.add(int64_t(v.size()));
    for (const auto& [name, text] : v) h.add(name).add(text);
  }
};

template <typename T>
const T* find_named(const std::vector<T>& all, std::string_view name) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const T& t) { return t.name == name; });
  return at == all.end() ? nullptr : &*at;
}

}  // namespace

void add_to(Hasher& hasher, const Params& params) {
  hasher.add(int64_t(params.size()));
  for (const auto& [name, value] : params) {
    hasher.add(name).add(int(value.index()));
    std::visit(AddParam{hasher}, value);
  }
}

const Port* NodeType::find_input(std::string_view port) const {
  return find_named(inputs, port);
}
const Port* NodeType::find_output(std::string_view port) const {
  return find_named(outputs, port);
}
const Param* NodeType::find_param(std::string_view param) const {
  return find_named(params, param);
}

NodeContext::NodeContext(const NodeType& type, Params params, std::map<std::string, std::vector<Value>> inputs,
                         Digest key, Task task)
    : type_(type), params_(std::move(params)), inputs_(std::move(inputs)), key_(key), task_(std::move(task)) {}

const std::vector<Value>& NodeContext::values(std::string_view port) const {
  static const std::vector<Value> none;
  if (!type_.find_input(port)) throw std::logic_error(fmt::format("{} declares no input {}", type_.name, port));
  const auto at = inputs_.find(std::string(port));
  return at == inputs_.end() ? none : at->second;
}

const Value& NodeContext::single(std::string_view port) const {
  const std::vector<Value>& v = values(port);
  if (v.size() != 1) throw std::logic_error(fmt::format("input {} of {} is not connected once", port, type_.name));
  return v.front();
}

const ParamValue& NodeContext::value(std::string_view param) const {
  const auto at = params_.find(std::string(param));
  if (at == params_.end()) throw std::logic_error(fmt::format("{} declares no parameter {}", type_.name, param));
  return at->second;
}

void NodeContext::compute() {
  if (type_.infer) {
    InputForecasts known;
    for (const auto& [port, values] : inputs_)
      for (const Value& v : values) known[port].push_back(forecast_of(v));
    inferred_ = type_.infer(params_, known);
  }
  type_.compute(*this);
}

void NodeContext::output(std::string_view port, Value value) {
  const Port* declared = type_.find_output(port);
  if (!declared || declared->type != type_of(value))
    throw std::logic_error(
        fmt::format("{} declares no output {} of type {}", type_.name, port, name_of(type_of(value))));
  if (std::visit([](const auto& pointer) { return pointer == nullptr; }, value))
    throw std::logic_error(fmt::format("{} gave a null pointer for its output {}", type_.name, port));
  outputs_.insert_or_assign(std::string(port), std::move(value));
}

std::filesystem::path NodeContext::stage(const std::filesystem::path& target) {
  WriteGuard::check(target);
  const std::filesystem::path folder = target.parent_path();
  if (const std::string trouble = why_not_writable(folder, target.filename().string()); !trouble.empty())
    throw Error(trouble);
  std::error_code failure;
  std::vector<std::filesystem::path> missing;
  for (std::filesystem::path f = folder; !f.empty() && !std::filesystem::exists(f, failure); f = f.parent_path())
    missing.push_back(f);
  made_folders_.insert(made_folders_.end(), missing.rbegin(), missing.rend());
  const std::filesystem::path place = WriteGuard::made_folder(folder);
  const bool known = std::any_of(staged_.begin(), staged_.end(),
                                 [&](const StagedFile& f) { return f.target.parent_path() == folder; });
  if (!known) remove_abandoned(place);
  staged_.push_back({temporary_beside(place / target.filename()), target});
  return staged_.back().temporary;
}

}  // namespace terrazzo
