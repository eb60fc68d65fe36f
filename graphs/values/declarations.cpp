#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/values/convert.h"
#include "graphs/values/parameters.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

bool takes_range(ParamType type) {
  return type == ParamType::integer || type == ParamType::number || type == ParamType::size ||
         type == ParamType::numbers || type == ParamType::number_map;
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
    if (const JsonValue* group = text_at("group")) out_.group = group->text;
    if (const JsonValue* unit = text_at("unit")) out_.param.unit = unit->text;
    read_condition();
    if (read_range() && read_choices()) {
      read_default();
    } else {
      out_.is_wrong = true;
    }
    return out_;
  }

 private:
  void check_keys() {
    static const std::vector<std::string> keys = {"type", "default", "help",  "min",       "max",
                                                  "unit", "choices", "group", "visible_if"};
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
    if (out_.param.type == ParamType::path) out_.param.library = LibraryFile::kept;
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

  void read_condition() {
    const JsonValue* v = text_at("visible_if");
    if (v && !is_expression(v->text)) {
      complaints_.add(v->place,
                      fmt::format("expected an expression such as \"=quality == 'best'\", found {}", found(*v)));
      v = nullptr;
    }
    if (v) out_.visible_if = *v;
  }

  void read_default() {
    const JsonValue* v = json_.find("default");
    if (!v) return;
    if (v->is_text() && is_expression(v->text)) {
      out_.formula = formula_of(*v, folder_, {}, complaints_);
      out_.is_wrong = !out_.formula;
      return;
    }
    if (out_.param.type == ParamType::path && v->is_text()) {
      out_.param.fallback = v->text;
      out_.as_written = v->text;
      out_.value = read_param(*v, out_.param, folder_, complaints_);
      out_.is_wrong = !out_.value;
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

}  // namespace

std::vector<GraphParameter> read_parameters(const JsonValue& section, const fs::path& folder,
                                            std::vector<Problem>& problems) {
  std::vector<GraphParameter> out;
  if (!section.is_object())
    problems.push_back(
        {section.place, "\"parameters\"", "expected an object of parameters by name, found " + found(section)});
  for (const JsonMember& m : section.members) out.push_back(Declaration(m, folder, problems).read());
  return out;
}

}  // namespace terrazzo
