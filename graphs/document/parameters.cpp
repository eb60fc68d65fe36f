#include "graphs/document/parameters.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "graphs/document/convert.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

bool takes_range(ParamType type) {
  return type == ParamType::integer || type == ParamType::number || type == ParamType::size ||
         type == ParamType::numbers || type == ParamType::number_map;
}

/// A `$name` or `${name}` in a text.
struct Reference {
  std::string name;
  size_t end = 0;
};

/// Empty if no name follows the $ at `at`.
std::optional<Reference> reference_at(const std::string& text, size_t at) {
  const bool is_braced = text.compare(at, 2, "${") == 0;
  const size_t begin = at + 1 + is_braced;
  size_t end = begin;
  while (end < text.size() && is_word(text[end])) end++;
  const bool is_closed = !is_braced || (end < text.size() && text[end] == '}');
  if (end == begin || !is_closed) return std::nullopt;
  return Reference{text.substr(begin, end - begin), end + is_braced};
}

JsonValue placed(JsonValue value, Place place) {
  value.place = place;
  for (JsonValue& item : value.items) item = placed(std::move(item), place);
  for (JsonMember& m : value.members) m = {m.name, place, placed(std::move(m.value), place)};
  return value;
}

/// Reads one declaration: {"type": "int", "default": 1, ...}.
class Declaration {
 public:
  Declaration(const JsonMember& member, const fs::path& folder, std::vector<Problem>& problems)
      : json_(member.value),
        folder_(folder),
        complaints_(problems, "parameter " + in_quotes(member.name)),
        out_{.param = {.name = member.name}, .place = member.place, .value = {}, .as_written = ""} {}

  GraphParameter read() {
    out_.is_wrong = true;
    if (!is_parameter_name(out_.param.name))
      complaints_.add(out_.place, "expected a name of letters, digits and _ that begins with a letter");
    if (!json_.is_object()) {
      complaints_.add(json_.place,
                      "expected an object such as {\"type\": \"int\", \"default\": 1}, found " + found(json_));
      return out_;
    }
    check_keys();
    if (!read_type()) return out_;
    out_.is_wrong = false;
    if (const JsonValue* help = text_at("help")) out_.param.help = help->text;
    if (read_range() && read_choices()) {
      read_default();
    } else {
      out_.is_wrong = true;
    }
    return out_;
  }

 private:
  void check_keys() {
    static const std::vector<std::string> keys = {"type", "default", "help", "min", "max", "choices"};
    for (const JsonMember& m : json_.members)
      if (std::find(keys.begin(), keys.end(), m.name) == keys.end())
        complaints_.add(m.place, fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, keys)));
  }

  const JsonValue* text_at(std::string_view key) {
    const JsonValue* v = json_.find(key);
    if (!v || v->is_text()) return v;
    complaints_.add(v->place, fmt::format("expected a text for \"{}\", found {}", key, found(*v)));
    return nullptr;
  }

  bool read_type() {
    const std::vector<std::string>& names = parameter_type_names();
    if (!json_.find("type")) {
      complaints_.add(json_.place, fmt::format("expected a \"type\": {}", listed(names)));
      return false;
    }
    const JsonValue* type = text_at("type");
    if (!type) return false;
    const auto at = std::find(names.begin(), names.end(), type->text);
    if (at == names.end()) {
      complaints_.add(type->place,
                      fmt::format("unknown type {}{}", in_quotes(type->text), suggestion(type->text, names)));
      return false;
    }
    out_.param.type = static_cast<ParamType>(at - names.begin());
    return true;
  }

  bool read_range() {
    bool is_right = true;
    const auto refuse = [&](const JsonValue& v, const std::string& message) {
      complaints_.add(v.place, message);
      is_right = false;
    };
    for (const auto& [key, bound] : {std::pair("min", &out_.param.min), std::pair("max", &out_.param.max)}) {
      const JsonValue* v = json_.find(key);
      if (!v) continue;
      if (!takes_range(out_.param.type)) {
        refuse(*v,
               fmt::format("\"{}\" is for numbers, not for a parameter of type \"{}\"", key, json_.find("type")->text));
      } else if (!v->is_number()) {
        refuse(*v, fmt::format("expected a number for \"{}\", found {}", key, found(*v)));
      } else {
        *bound = v->number;
      }
    }
    if (out_.param.min && out_.param.max && *out_.param.min > *out_.param.max)
      refuse(*json_.find("min"),
             fmt::format("\"min\" is {}, above \"max\", which is {}", *out_.param.min, *out_.param.max));
    return is_right;
  }

  bool read_choices() {
    const JsonValue* v = json_.find("choices");
    const bool is_choice = out_.param.type == ParamType::choice;
    if (!v && !is_choice) return true;
    bool all_texts = v && v->is_list() && !v->items.empty();
    if (!v) {
      complaints_.add(json_.place, "a parameter of type \"choice\" needs \"choices\", a list of texts");
    } else if (!is_choice) {
      complaints_.add(v->place, "\"choices\" is for a parameter of type \"choice\"");
    } else {
      for (const JsonValue& item : v->items) {
        all_texts &= item.is_text();
        out_.param.choices.push_back(item.text);
      }
      if (!all_texts) complaints_.add(v->place, "expected a list of texts for \"choices\", found " + found(*v));
    }
    return is_choice && all_texts;
  }

  void read_default() {
    const JsonValue* v = json_.find("default");
    if (!v) return;
    if (out_.param.type == ParamType::path && v->is_text()) {
      out_.param.fallback = v->text;
      out_.as_written = v->text;
      out_.value = default_of(out_.param, folder_);
      return;
    }
    out_.value = read_param(*v, out_.param, folder_, complaints_);
    out_.param.fallback = out_.value;
    out_.is_wrong = !out_.value;
  }

  const JsonValue& json_;
  const fs::path& folder_;
  Diagnostics complaints_;
  GraphParameter out_;
};

/// The end of a message about a graph parameter that is not there.
std::string hint_for(const std::string& wrong, const std::vector<std::string>& names, const NodeTypes& nodes) {
  std::vector<std::string> of_nodes;
  for (const auto& [node, type] : nodes) {
    if (node == wrong) return fmt::format("; \"{0}\" is a node: write {0}.parameter=value", wrong);
    if (type && type->find_param(wrong)) of_nodes.push_back(node + "." + wrong);
  }
  const std::string own = names.empty()      ? "; it has none"
                          : of_nodes.empty() ? suggestion(wrong, names)
                                             : fmt::format(" (valid: {})", listed(names));
  return of_nodes.empty() ? own : fmt::format("{}; did you mean {}?", own, listed(of_nodes));
}

}  // namespace

const std::vector<std::string>& parameter_type_names() {
  static const std::vector<std::string> names = {"bool",  "int",        "number",   "text",   "size", "numbers",
                                                 "texts", "number_map", "text_map", "choice", "path"};
  return names;
}

bool is_parameter_name(const std::string& name) {
  return !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), is_word);
}

bool is_node_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return is_word(c) || c == '-'; });
}

std::vector<GraphParameter> read_parameters(const JsonValue& section, const fs::path& folder,
                                            std::vector<Problem>& problems) {
  std::vector<GraphParameter> out;
  if (!section.is_object())
    problems.push_back(
        {section.place, "\"parameters\"", "expected an object of parameters by name, found " + found(section)});
  for (const JsonMember& m : section.members) out.push_back(Declaration(m, folder, problems).read());
  return out;
}

void set_parameters(std::vector<GraphParameter>& parameters, const std::vector<Override>& overrides,
                    const fs::path& folder, const NodeTypes& nodes, std::vector<Problem>& problems) {
  std::vector<std::string> names;
  for (const GraphParameter& p : parameters) names.push_back(p.param.name);
  for (const Override& o : overrides) {
    if (!o.node.empty()) continue;
    Diagnostics diagnostics = o.diagnostics(problems);
    const auto at = std::find(names.begin(), names.end(), o.name);
    if (at == names.end()) {
      diagnostics.add(
          {}, fmt::format("the graph has no parameter {}{}", in_quotes(o.name), hint_for(o.name, names, nodes)));
      continue;
    }
    GraphParameter& p = parameters[at - names.begin()];
    p.overridden = true;
    if (p.is_wrong) continue;
    p.as_written = o.value;
    p.value = read_param(read_command_line(o.value, p.param), p.param, folder, diagnostics);
    p.is_wrong = !p.value;
  }
}

Substitution::Substitution(const std::vector<GraphParameter>& parameters) {
  for (const GraphParameter& p : parameters) {
    uses_.emplace(p.param.name, Use{&p});
    names_.push_back(p.param.name);
  }
}

const GraphParameter* Substitution::find(const std::string& name, Place place, Diagnostics& diagnostics) {
  const auto at = uses_.find(name);
  if (at == uses_.end()) {
    const std::string hint = names_.empty() ? "; it has none" : suggestion(name, names_);
    diagnostics.add(place, fmt::format("${}: the graph has no parameter of that name{}", name, hint));
    return nullptr;
  }
  at->second.used = true;
  return at->second.parameter;
}

std::optional<JsonValue> Substitution::expand(const JsonValue& value, bool wants_text, Diagnostics& diagnostics) {
  std::optional<JsonValue> out = expand_part(value, wants_text, diagnostics);
  const bool has_changed = out && value.is_text() && (!out->is_text() || out->text != value.text);
  if (has_changed) diagnostics.set_origin(fmt::format(" (from {})", in_quotes(value.text)));
  return out;
}

std::optional<JsonValue> Substitution::expand_part(const JsonValue& value, bool wants_text, Diagnostics& diagnostics) {
  if (value.is_text()) return expand_text(value, wants_text, diagnostics);
  JsonValue out = value;
  bool complete = true;
  const auto replace = [&](JsonValue& part) {
    std::optional<JsonValue> expanded = expand_part(part, wants_text, diagnostics);
    complete &= expanded.has_value();
    if (expanded) part = std::move(*expanded);
  };
  for (JsonValue& item : out.items) replace(item);
  for (JsonMember& m : out.members) replace(m.value);
  return complete ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<JsonValue> Substitution::expand_text(const JsonValue& value, bool wants_text, Diagnostics& diagnostics) {
  const std::string& text = value.text;
  if (text.starts_with("@") && !text.starts_with("@@")) {
    diagnostics.add(
        value.place,
        fmt::format("a parameter takes no wire; found {} (write @@ for a text that begins with @)", in_quotes(text)));
    return std::nullopt;
  }
  JsonValue out = value;
  out.text.clear();
  bool complete = true;
  for (size_t at = text.starts_with("@@") ? 1 : 0; at < text.size();) {
    if (text[at] != '$' || text.compare(at, 2, "$$") == 0) {
      out.text += text[at];
      at += text[at] == '$' ? 2 : 1;
      continue;
    }
    const std::optional<Reference> reference = reference_at(text, at);
    if (!reference) {
      diagnostics.add(
          value.place,
          fmt::format("expected a parameter's name after $ in {} (a plain dollar is written $$)", in_quotes(text)));
      return std::nullopt;
    }
    const GraphParameter* parameter = find(reference->name, value.place, diagnostics);
    if (parameter && parameter->value) {
      const bool is_whole = at == 0 && reference->end == text.size();
      if (is_whole && !wants_text) return placed(json_of(*parameter->value), value.place);
      const bool keeps_spelling = parameter->param.type == ParamType::path && at > 0;
      out.text += keeps_spelling ? parameter->as_written : text_of(*parameter->value);
    } else {
      if (parameter) unset_.insert(reference->name);
      complete = false;
    }
    at = reference->end;
  }
  return complete ? std::optional(std::move(out)) : std::nullopt;
}

std::set<std::string> Substitution::paths_in(const JsonValue& value) const {
  std::set<std::string> out;
  for (size_t at = value.text.find('$'); at != std::string::npos; at = value.text.find('$', at + 1)) {
    if (value.text.compare(at, 2, "$$") == 0) {
      at++;
      continue;
    }
    const std::optional<Reference> reference = reference_at(value.text, at);
    const auto use = reference ? uses_.find(reference->name) : uses_.end();
    if (use != uses_.end() && use->second.parameter->param.type == ParamType::path) out.insert(reference->name);
  }
  return out;
}

std::vector<const GraphParameter*> Substitution::unused() const {
  std::vector<const GraphParameter*> out;
  for (const std::string& name : names_)
    if (const Use& use = uses_.at(name); !use.used) out.push_back(use.parameter);
  return out;
}

}  // namespace terrazzo
