#include "graphs/values/convert.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/path_spelling.h"
#include "graphs/library/library.h"
#include "graphs/text/format.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

using Kind = JsonValue::Kind;

std::string range_of(const Param& p) {
  const std::string unit = p.unit.empty() ? "" : " " + p.unit;
  if (p.min && p.max) return fmt::format(" from {} to {}{}", *p.min, *p.max, unit);
  if (p.min) return fmt::format(" of at least {}{}", *p.min, unit);
  if (p.max) return fmt::format(" of at most {}{}", *p.max, unit);
  return p.unit.empty() ? "" : fmt::format(" ({})", p.unit);
}

std::string count_of(const Param& p) {
  if (p.min_count > 0 && p.min_count == p.max_count) return fmt::format("{} ", p.min_count);
  if (p.min_count > 0 && p.max_count > 0) return fmt::format("{} to {} ", p.min_count, p.max_count);
  if (p.min_count > 0) return fmt::format("at least {} ", p.min_count);
  if (p.max_count > 0) return fmt::format("at most {} ", p.max_count);
  return "";
}

std::string names_of(const Param& p) {
  return p.choices.empty() ? "" : fmt::format(" (names: {})", listed(p.choices));
}

std::string absolute(const std::string& text, const fs::path& base) {
  if (text.empty()) return text;
  std::string out = (base / text).lexically_normal().string();
  if (out.size() > 1 && out.back() == '/') out.pop_back();
  return out;
}

class Reader {
 public:
  Reader(const Param& param, const fs::path& base, Diagnostics& diagnostics)
      : param_(param), base_(base), complaints_(diagnostics) {}

  std::optional<ParamValue> read(const JsonValue& v) {
    switch (param_.type) {
      case ParamType::boolean:
        if (v.kind == Kind::boolean) return v.boolean;
        return wrong(v);
      case ParamType::integer:
        return as_value(integer(v));
      case ParamType::number:
        return as_value(number(v, expectation(param_)));
      case ParamType::text:
        if (v.is_text()) return v.text;
        return wrong(v);
      case ParamType::size:
        return as_value(size(v));
      case ParamType::numbers:
        return as_value(numbers(v));
      case ParamType::texts:
        return as_value(texts(v));
      case ParamType::number_map:
        return as_value(number_map(v));
      case ParamType::text_map:
        return as_value(text_map(v));
      case ParamType::choice:
        return as_value(choice(v));
      case ParamType::path:
        return as_value(path(v));
    }
    return std::nullopt;
  }

 private:
  template <typename T>
  static std::optional<ParamValue> as_value(std::optional<T> value) {
    if (!value) return std::nullopt;
    return ParamValue(std::move(*value));
  }

  std::nullopt_t report(const JsonValue& v, const std::string& expected, const std::string& hint = "") {
    complaints_.add(v.place, fmt::format("expected {}, found {}{}", expected, found(v), hint));
    return std::nullopt;
  }
  std::nullopt_t wrong(const JsonValue& v, const std::string& hint = "") {
    return report(v, expectation(param_), hint);
  }

  bool in_range(double d) const { return !(param_.min && d < *param_.min) && !(param_.max && d > *param_.max); }

  std::optional<int64_t> integer(const JsonValue& v) {
    constexpr double exact = 9007199254740992;  // doubles hold every integer up to here
    if (!v.is_number()) return wrong(v);
    const bool is_whole = v.kind == Kind::integer || (std::trunc(v.number) == v.number && std::abs(v.number) <= exact);
    if (is_whole && in_range(v.number)) return v.kind == Kind::integer ? v.integer : static_cast<int64_t>(v.number);
    constexpr double beyond = 9223372036854775808.0;
    return std::abs(v.number) < beyond ? wrong(v) : report(v, "an integer" + full_range());
  }

  /// The range of an integer parameter; the limits of 64-bit integers stand for missing bounds.
  std::string full_range() const {
    using Limits = std::numeric_limits<int64_t>;
    const auto bound = [](const std::optional<double>& own, int64_t limit) {
      return own ? fmt::format("{}", *own) : fmt::format("{}", limit);
    };
    return fmt::format(" from {} to {}{}{}", bound(param_.min, Limits::min()), bound(param_.max, Limits::max()),
                       param_.unit.empty() ? "" : " ", param_.unit);
  }

  std::optional<double> number(const JsonValue& v, const std::string& expected) {
    if (!v.is_number() || !in_range(v.number)) return report(v, expected);
    return v.number;
  }

  std::optional<int> side(double d) const {
    const double least = param_.min.value_or(1);
    const double most = param_.max.value_or(std::numeric_limits<int>::max());
    if (std::trunc(d) != d || d < least || d > most) return std::nullopt;
    return static_cast<int>(d);
  }

  std::optional<Size> size(const JsonValue& v) {
    std::optional<int> width, height;
    if (v.is_number()) {
      width = height = side(v.number);
    } else if (v.is_list() && v.items.size() == 2 && v.items[0].is_number() && v.items[1].is_number()) {
      width = side(v.items[0].number);
      height = side(v.items[1].number);
    } else if (v.is_text()) {
      int w = 0, h = 0;
      const char* const end = v.text.data() + v.text.size();
      const auto first = std::from_chars(v.text.data(), end, w);
      if (first.ec != std::errc() || first.ptr == end || (*first.ptr != 'x' && *first.ptr != 'X')) return wrong(v);
      const auto second = std::from_chars(first.ptr + 1, end, h);
      if (second.ec != std::errc() || second.ptr != end) return wrong(v);
      width = side(w);
      height = side(h);
    }
    if (!width || !height) {
      const bool both = v.is_list() && v.items.size() == 2 && v.items[0].is_number() && v.items[1].is_number();
      return wrong(v, both ? fmt::format(": [{}, {}]", v.items[0].text, v.items[1].text) : "");
    }
    return Size{*width, *height};
  }

  bool count_is_right(const JsonValue& v) {
    const auto count = static_cast<int64_t>(v.items.size());
    if (count >= param_.min_count && (param_.max_count == 0 || count <= param_.max_count)) return true;
    wrong(v);
    return false;
  }

  /// A list of numbers, or one number.
  std::optional<Numbers> number_list(const JsonValue& v, const std::string& expected) {
    const std::string one = "a number" + range_of(param_);
    if (v.is_number()) {
      const std::optional<double> d = number(v, one);
      return d ? std::optional(Numbers{*d}) : std::nullopt;
    }
    if (!v.is_list()) return report(v, expected);
    Numbers out;
    for (const JsonValue& item : v.items)
      if (const std::optional<double> d = number(item, one)) out.push_back(*d);
    return out.size() == v.items.size() ? std::optional(out) : std::nullopt;
  }

  std::optional<Numbers> numbers(const JsonValue& v) {
    if (v.is_list() && !count_is_right(v)) return std::nullopt;
    if (!v.is_list() && (v.is_text() || param_.min_count > 1)) return wrong(v, brackets(v));
    return number_list(v, expectation(param_));
  }
  /// A hint on missing brackets: 200,300 was probably meant as a list.
  static std::string brackets(const JsonValue& v) {
    const bool lacks_them = v.is_text() && v.text.find(',') != std::string::npos &&
                            v.text.find_first_not_of("0123456789.,-+ ") == std::string::npos;
    return lacks_them ? fmt::format("; write [{}]", v.text) : "";
  }

  std::optional<Texts> texts(const JsonValue& v) {
    if (!v.is_list()) return wrong(v);
    if (!count_is_right(v)) return std::nullopt;
    Texts out;
    for (const JsonValue& item : v.items) {
      if (item.is_text()) {
        out.push_back(item.text);
      } else {
        report(item, "a text");
      }
    }
    return out.size() == v.items.size() ? std::optional(out) : std::nullopt;
  }

  bool name_is_known(const JsonMember& m) {
    if (param_.choices.empty()) return true;
    for (const std::string& known : param_.choices)
      if (known == m.name) return true;
    complaints_.add(m.place, fmt::format("unknown name {}{}", in_quotes(m.name), suggestion(m.name, param_.choices)));
    return false;
  }

  std::optional<NumberMap> number_map(const JsonValue& v) {
    if (!v.is_object()) return wrong(v);
    NumberMap out;
    for (const JsonMember& m : v.members) {
      const bool known = name_is_known(m);
      std::optional<Numbers> list = number_list(
          m.value, fmt::format("a number{}, or a list of them, for {}", range_of(param_), in_quotes(m.name)));
      if (known && list && list->empty()) report(m.value, fmt::format("at least one number for {}", in_quotes(m.name)));
      if (known && list && !list->empty()) out.emplace(m.name, std::move(*list));
    }
    return out.size() == v.members.size() ? std::optional(out) : std::nullopt;
  }

  std::optional<TextMap> text_map(const JsonValue& v) {
    if (!v.is_object()) return wrong(v);
    TextMap out;
    for (const JsonMember& m : v.members) {
      const bool known = name_is_known(m);
      if (!m.value.is_text()) report(m.value, fmt::format("a text for {}", in_quotes(m.name)));
      if (known && m.value.is_text()) out.emplace(m.name, m.value.text);
    }
    return out.size() == v.members.size() ? std::optional(out) : std::nullopt;
  }

  std::optional<std::string> choice(const JsonValue& v) {
    if (!v.is_text()) return wrong(v);
    for (const std::string& c : param_.choices)
      if (c == v.text) return v.text;
    return wrong(v, did_you_mean(v.text, param_.choices));
  }

  std::optional<std::string> path(const JsonValue& v) {
    const bool may_be_empty = param_.fallback && *param_.fallback == ParamValue(std::string());
    if (!v.is_text() || (v.text.empty() && !may_be_empty)) return wrong(v);
    if (is_library_reference(v.text)) return in_library(v);
    if (const std::string advice = path_advice(base_, v.text); !advice.empty())
      return report(v, "a path", "; " + advice);
    return absolute(v.text, base_);
  }

  std::optional<std::string> in_library(const JsonValue& v) {
    if (param_.library == LibraryFile::kept) return v.text;
    if (param_.library == LibraryFile::none)
      return report(v, "a path", "; only load_analysis, and load_material for its maps, take an analysis by name");
    try {
      return library_file(v.text, param_.library).string();
    } catch (const Error& e) {
      complaints_.add(v.place, e.what());
      return std::nullopt;
    }
  }

  const Param& param_;
  const fs::path& base_;
  Diagnostics& complaints_;
};

struct ToJson {
  static JsonValue of(bool v) {
    JsonValue json;
    json.kind = Kind::boolean;
    json.boolean = v;
    return json;
  }
  static JsonValue of(int64_t v) { return JsonValue::of(v); }
  static JsonValue of(double v) {
    JsonValue json;
    json.kind = Kind::number;
    json.number = v;
    json.text = fmt::format("{}", v);
    return json;
  }
  static JsonValue of(const std::string& v) { return JsonValue::of(v); }
  static JsonValue of(Size v) { return list(std::vector<int64_t>{v.width, v.height}); }
  static JsonValue of(const Numbers& v) { return list(v); }
  static JsonValue of(const Texts& v) { return list(v); }
  static JsonValue of(const TextMap& v) { return object(v); }
  static JsonValue of(const NumberMap& v) {
    JsonValue json = object(v);
    for (JsonMember& m : json.members)
      if (m.value.items.size() == 1) m.value = JsonValue(m.value.items.front());
    return json;
  }

  template <typename T>
  static JsonValue list(const std::vector<T>& values) {
    JsonValue json;
    json.kind = Kind::list;
    for (const T& v : values) json.items.push_back(of(v));
    return json;
  }
  template <typename T>
  static JsonValue object(const std::map<std::string, T>& values) {
    JsonValue json;
    json.kind = Kind::object;
    for (const auto& [name, v] : values) json.members.push_back({name, {}, of(v)});
    return json;
  }
};

}  // namespace

std::optional<ParamValue> read_param(const JsonValue& json, const Param& param, const fs::path& base,
                                     Diagnostics& diagnostics) {
  return Reader(param, base, diagnostics).read(json);
}

ParamValue default_of(const Param& param, const fs::path& base) {
  if (param.type != ParamType::path) return *param.fallback;
  if (const auto& text = std::get<std::string>(*param.fallback); !is_library_reference(text))
    return absolute(text, base);
  std::vector<Problem> none;
  Diagnostics diagnostics(none, "");
  return *read_param(json_of(*param.fallback), param, base, diagnostics);
}

JsonValue json_of(const ParamValue& value) {
  return std::visit([](const auto& v) { return ToJson::of(v); }, value);
}

std::string text_of(const ParamValue& value) {
  if (const Size* size = std::get_if<Size>(&value)) return fmt::format("{}x{}", size->width, size->height);
  const JsonValue json = json_of(value);
  return json.is_text() ? json.text : compact(json);
}

std::string expectation(const Param& p) {
  switch (p.type) {
    case ParamType::boolean:
      return "true or false";
    case ParamType::integer:
      return "an integer" + range_of(p);
    case ParamType::number:
      return "a number" + range_of(p);
    case ParamType::text:
      return "a text";
    case ParamType::size: {
      Param sides = p;
      sides.min = p.min.value_or(1);
      return fmt::format("a size such as [512, 256], \"512x256\" or 512, sides{}", range_of(sides));
    }
    case ParamType::numbers:
      return fmt::format("a list of {}numbers{}", count_of(p), range_of(p));
    case ParamType::texts:
      return fmt::format("a list of {}texts", count_of(p));
    case ParamType::number_map:
      return fmt::format("an object of numbers{} by name{}", range_of(p), names_of(p));
    case ParamType::text_map:
      return fmt::format("an object of texts by name{}", names_of(p));
    case ParamType::choice:
      return listed(p.choices);
    case ParamType::path:
      return "a path";
  }
  return "";
}

}  // namespace terrazzo
