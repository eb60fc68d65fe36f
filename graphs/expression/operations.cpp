#include "graphs/expression/operations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/suggest.h"

namespace terrazzo::expression {

namespace {

/// An integer or floating-point number, the element of lists and sizes.
using Number = std::variant<int64_t, double>;

double real(const Number& n) {
  return std::visit([](auto v) { return double(v); }, n);
}

const int64_t* whole(const Number& n) {
  return std::get_if<int64_t>(&n);
}

/// An integer if the value is one, so that results stay exact.
Number simplest(double v) {
  constexpr double exact = 9007199254740992;  // doubles hold every integer up to here
  if (!std::isfinite(v)) throw Error("the result is not a finite number");
  if (std::trunc(v) == v && std::abs(v) <= exact) return static_cast<int64_t>(v);
  return v;
}

/// A value as numbers: one, or the elements of a size or a list.
struct Elements {
  std::vector<Number> numbers;
  bool is_single = false;
};

Elements elements_of(const ExpressionValue& v, const std::string& for_what) {
  if (const auto* i = std::get_if<int64_t>(&v.value)) return {{*i}, true};
  if (const auto* d = std::get_if<double>(&v.value)) return {{simplest(*d)}, true};
  if (const auto* s = std::get_if<Size>(&v.value)) return {{int64_t(s->width), int64_t(s->height)}};
  if (const auto* all = std::get_if<Numbers>(&v.value)) {
    Elements out;
    for (const double d : *all) out.numbers.push_back(simplest(d));
    return out;
  }
  throw Error(fmt::format("{} takes numbers, found {}", for_what, described(v)));
}

ParamValue value_of(const Elements& e) {
  if (e.is_single) return std::visit([](auto v) { return ParamValue(v); }, e.numbers.front());
  Numbers out;
  for (const Number& n : e.numbers) out.push_back(real(n));
  return out;
}

using Pairwise = std::function<Number(const Number&, const Number&)>;

Elements pairwise(const Elements& a, const Elements& b, const Pairwise& f) {
  if (!a.is_single && !b.is_single && a.numbers.size() != b.numbers.size())
    throw Error(
        fmt::format("expected lists of equal length, found {} and {} numbers", a.numbers.size(), b.numbers.size()));
  Elements out{{}, a.is_single && b.is_single};
  for (size_t i = 0; i < std::max(a.numbers.size(), b.numbers.size()); i++)
    out.numbers.push_back(f(a.numbers[a.is_single ? 0 : i], b.numbers[b.is_single ? 0 : i]));
  return out;
}

std::string common_unit(const std::string& what, const std::string& a, const std::string& b) {
  if (!a.empty() && !b.empty() && a != b) throw Error(fmt::format("{} of {} and {}: the units differ", what, a, b));
  return a.empty() ? b : a;
}

[[noreturn]] void too_large() {
  throw Error("the result does not fit into 64 bits");
}

Number sum(const Number& a, const Number& b) {
  if (!whole(a) || !whole(b)) return simplest(real(a) + real(b));
  int64_t out = 0;
  if (__builtin_add_overflow(*whole(a), *whole(b), &out)) too_large();
  return out;
}

Number difference(const Number& a, const Number& b) {
  if (!whole(a) || !whole(b)) return simplest(real(a) - real(b));
  int64_t out = 0;
  if (__builtin_sub_overflow(*whole(a), *whole(b), &out)) too_large();
  return out;
}

Number product(const Number& a, const Number& b) {
  if (!whole(a) || !whole(b)) return simplest(real(a) * real(b));
  int64_t out = 0;
  if (__builtin_mul_overflow(*whole(a), *whole(b), &out)) too_large();
  return out;
}

Number quotient(const Number& a, const Number& b) {
  if (real(b) == 0) throw Error("division by zero");
  // -2^63 / -1 has no whole result.
  if (whole(a) && whole(b) && *whole(b) != -1 && *whole(a) % *whole(b) == 0) return *whole(a) / *whole(b);
  return simplest(real(a) / real(b));
}

/// The modulus, always between 0 and the divisor, as expected for repeating patterns.
Number remainder(const Number& a, const Number& b) {
  if (real(b) == 0) throw Error("division by zero");
  if (whole(a) && whole(b)) {
    if (*whole(b) == -1) return int64_t(0);
    const int64_t left = *whole(a) % *whole(b);
    return left != 0 && (left < 0) != (*whole(b) < 0) ? left + *whole(b) : left;
  }
  return simplest(real(a) - std::floor(real(a) / real(b)) * real(b));
}

bool below(const Number& a, const Number& b) {
  if (whole(a) && whole(b)) return *whole(a) < *whole(b);
  return real(a) < real(b);
}

ExpressionValue arithmetic(const std::string& op, const ExpressionValue& a, const ExpressionValue& b) {
  const Elements left = elements_of(a, op), right = elements_of(b, op);
  if (op == "+") return {value_of(pairwise(left, right, sum)), common_unit("a sum", a.unit, b.unit)};
  if (op == "-") return {value_of(pairwise(left, right, difference)), common_unit("a difference", a.unit, b.unit)};
  if (op == "%") return {value_of(pairwise(left, right, remainder)), common_unit("a remainder", a.unit, b.unit)};
  if (op == "*") {
    if (!a.unit.empty() && !b.unit.empty()) throw Error(fmt::format("{} times {} is not a unit here", a.unit, b.unit));
    return {value_of(pairwise(left, right, product)), a.unit.empty() ? b.unit : a.unit};
  }
  if (!b.unit.empty() && a.unit != b.unit)
    throw Error(fmt::format("{} divided by {} is not a unit here", a.unit.empty() ? "a number" : a.unit, b.unit));
  return {value_of(pairwise(left, right, quotient)), b.unit.empty() ? a.unit : ""};
}

bool is_single_number(const ExpressionValue& v) {
  return std::holds_alternative<int64_t>(v.value) || std::holds_alternative<double>(v.value);
}

bool equal(const ExpressionValue& a, const ExpressionValue& b) {
  const auto is_numeric = [](const ExpressionValue& v) {
    return is_single_number(v) || std::holds_alternative<Size>(v.value) || std::holds_alternative<Numbers>(v.value);
  };
  if (is_numeric(a) && is_numeric(b)) {
    common_unit("a comparison", a.unit, b.unit);
    const Elements left = elements_of(a, "=="), right = elements_of(b, "==");
    return left.is_single == right.is_single && left.numbers == right.numbers;
  }
  if (a.value.index() != b.value.index())
    throw Error(fmt::format("a comparison of {} and {}", described(a), described(b)));
  return a.value == b.value;
}

ExpressionValue comparison(const std::string& op, const ExpressionValue& a, const ExpressionValue& b) {
  if (op == "==") return {equal(a, b)};
  if (op == "!=") return {!equal(a, b)};
  for (const ExpressionValue* v : {&a, &b})
    if (!is_single_number(*v)) throw Error(fmt::format("{} compares numbers, found {}", op, described(*v)));
  common_unit("a comparison", a.unit, b.unit);
  const Number left = elements_of(a, op).numbers.front(), right = elements_of(b, op).numbers.front();
  if (op == "<") return {below(left, right)};
  if (op == ">") return {below(right, left)};
  if (op == "<=") return {!below(right, left)};
  return {!below(left, right)};
}

/// A function of numbers, element by element.
struct Function {
  std::string name;
  size_t least = 1, most = 1;  ///< arguments
  std::string usage;
};

const std::vector<Function>& functions() {
  static const std::vector<Function> all = {{"min", 2, 20, "min(a, b, ...)"},
                                            {"max", 2, 20, "max(a, b, ...)"},
                                            {"clamp", 3, 3, "clamp(value, least, most)"},
                                            {"round", 1, 2, "round(value, step)"},
                                            {"floor", 1, 2, "floor(value, step)"},
                                            {"ceil", 1, 2, "ceil(value, step)"},
                                            {"abs", 1, 1, "abs(value)"},
                                            {"sqrt", 1, 1, "sqrt(value)"},
                                            {"length", 1, 1, "length(list or text)"}};
  return all;
}

const Function* find_function(const std::string& name) {
  const auto at = std::ranges::find(functions(), name, &Function::name);
  return at == functions().end() ? nullptr : &*at;
}

Elements each(const Elements& e, const std::function<Number(const Number&)>& f) {
  Elements out{{}, e.is_single};
  for (const Number& n : e.numbers) out.numbers.push_back(f(n));
  return out;
}

/// Rounds halves up, independent of platform and rounding mode.
double rounded(const std::string& how, double v) {
  return how == "floor" ? std::floor(v) : how == "ceil" ? std::ceil(v) : std::floor(v + 0.5);
}

ExpressionValue round_to(const std::string& how, const std::vector<ExpressionValue>& arguments) {
  const ExpressionValue& v = arguments.front();
  const auto to_whole = [&](const Number& n) { return whole(n) ? n : simplest(rounded(how, real(n))); };
  if (arguments.size() == 1) return {value_of(each(elements_of(v, how), to_whole)), v.unit};
  const ExpressionValue& step = arguments[1];
  const std::string unit = common_unit("a step", v.unit, step.unit);
  const auto to_step = [&](const Number& n, const Number& s) {
    if (!(real(s) > 0)) throw Error(fmt::format("{} takes a step above 0, found {}", how, real(s)));
    return product(to_whole(quotient(n, s)), s);
  };
  return {value_of(pairwise(elements_of(v, how), elements_of(step, how), to_step)), unit};
}

/// A value formatted as part of a text.
std::string plain_text(const ExpressionValue& v) {
  if (const auto* text = std::get_if<std::string>(&v.value)) return *text;
  if (const auto* whole = std::get_if<int64_t>(&v.value)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&v.value)) return fmt::format("{}", *number);
  if (const auto* size = std::get_if<Size>(&v.value)) return fmt::format("{}x{}", size->width, size->height);
  throw Error(fmt::format("+ joins texts, numbers and sizes, found {}", described(v)));
}

ExpressionValue extreme(const std::string& name, const ExpressionValue& a, const ExpressionValue& b) {
  const bool largest = name == "max";
  const auto choose = [&](const Number& x, const Number& y) { return below(x, y) == largest ? y : x; };
  return {value_of(pairwise(elements_of(a, name), elements_of(b, name), choose)), common_unit(name, a.unit, b.unit)};
}

ExpressionValue length(const ExpressionValue& v) {
  const auto count = [](const auto& all) { return ExpressionValue{int64_t(all.size())}; };
  if (const auto* text = std::get_if<std::string>(&v.value)) return count(*text);
  if (const auto* numbers = std::get_if<Numbers>(&v.value)) return count(*numbers);
  if (const auto* texts = std::get_if<Texts>(&v.value)) return count(*texts);
  throw Error(fmt::format("length takes a list or a text, found {}", described(v)));
}

size_t bytes(const auto& v) {
  return sizeof(v);
}
size_t bytes(const std::string& text) {
  return text.size();
}
size_t bytes(const Numbers& numbers) {
  return numbers.size() * sizeof(double);
}
size_t bytes(const Texts& texts) {
  size_t sum = 0;
  for (const std::string& t : texts) sum += sizeof(std::string) + t.size();
  return sum;
}
template <typename T>
size_t bytes(const std::map<std::string, T>& values) {
  size_t sum = 0;
  for (const auto& [name, v] : values) sum += sizeof(name) + name.size() + bytes(v);
  return sum;
}

void require_room(const ParamValue& value) {
  if (bytes_of(value) > most_text_bytes) throw Error("the result is longer than 1 MiB");
}

}  // namespace

ExpressionValue negated(const ExpressionValue& v) {
  const auto negative = [](const Number& n) { return difference(int64_t(0), n); };
  return {value_of(each(elements_of(v, "-"), negative)), v.unit};
}

ExpressionValue operated(const std::string& op, const ExpressionValue& a, const ExpressionValue& b) {
  const auto is_text = [](const ExpressionValue& v) { return std::holds_alternative<std::string>(v.value); };
  if (op == "+" && (is_text(a) || is_text(b))) {
    std::string joined = plain_text(a) + plain_text(b);
    require_room(joined);
    return {std::move(joined)};
  }
  const bool is_arithmetic = op.size() == 1 && std::string("+-*/%").find(op) != std::string::npos;
  return is_arithmetic ? arithmetic(op, a, b) : comparison(op, a, b);
}

ExpressionValue listed_values(const std::vector<ExpressionValue>& parts) {
  const bool is_texts = !parts.empty() && std::holds_alternative<std::string>(parts.front().value);
  Texts texts;
  Numbers numbers;
  std::string unit;
  for (const ExpressionValue& p : parts) {
    const auto* text = std::get_if<std::string>(&p.value);
    if (is_texts != (text != nullptr) || (!text && !is_single_number(p)))
      throw Error(fmt::format("a list holds numbers or texts, found {}", described(p)));
    if (text) {
      texts.push_back(*text);
    } else {
      numbers.push_back(real(elements_of(p, "a list").numbers.front()));
      unit = common_unit("a list", unit, p.unit);
    }
  }
  if (!is_texts) return {std::move(numbers), unit};
  require_room(texts);
  return {std::move(texts)};
}

ExpressionValue member_of(const ExpressionValue& v, const std::string& name) {
  if (const auto* map = std::get_if<NumberMap>(&v.value)) {
    const auto at = map->find(name);
    if (at == map->end()) throw Error(fmt::format("there is no \"{}\" in it", name));
    if (at->second.size() == 1) return {at->second.front(), v.unit};
    return {at->second, v.unit};
  }
  if (const auto* map = std::get_if<TextMap>(&v.value)) {
    const auto at = map->find(name);
    if (at == map->end()) throw Error(fmt::format("there is no \"{}\" in it", name));
    return {at->second};
  }
  const bool is_pair = std::holds_alternative<Size>(v.value) ||
                       (std::holds_alternative<Numbers>(v.value) && std::get<Numbers>(v.value).size() == 2);
  if (!is_pair) throw Error(fmt::format("{} has no .{}", described(v), name));
  if (name != "x" && name != "y")
    throw Error(fmt::format("a size has .x, its width, and .y, its height; found .{}", name));
  const Number n = elements_of(v, "a dot").numbers[name == "y"];
  return {value_of({{n}, true}), v.unit};
}

bool truth(const ExpressionValue& v, const std::string& of_what) {
  if (const bool* b = std::get_if<bool>(&v.value)) return *b;
  throw Error(fmt::format("{} takes true or false, found {}", of_what, described(v)));
}

std::string unknown_function(const std::string& name) {
  if (find_function(name)) return "";
  std::vector<std::string> names;
  for (const Function& f : functions()) names.push_back(f.name);
  return fmt::format("unknown function \"{}\"{}", name, suggestion(name, names));
}

ExpressionValue called(const std::string& function, const std::vector<ExpressionValue>& arguments) {
  const Function* f = find_function(function);
  if (!f) throw Error(unknown_function(function));
  if (arguments.size() < f->least || arguments.size() > f->most)
    throw Error(fmt::format("expected {}, found {} arguments", f->usage, arguments.size()));
  const ExpressionValue& v = arguments.front();
  if (function == "length") return length(v);
  if (function == "clamp") return extreme("min", extreme("max", v, arguments[1]), arguments[2]);
  if (function == "abs")
    return {value_of(each(elements_of(v, function),
                          [](const Number& n) { return real(n) < 0 ? difference(int64_t(0), n) : n; })),
            v.unit};
  if (function == "sqrt") {
    if (!v.unit.empty()) throw Error(fmt::format("the square root of {} is not a unit here", v.unit));
    return {value_of(each(elements_of(v, function), [](const Number& n) {
      if (real(n) < 0) throw Error(fmt::format("the square root of {}", real(n)));
      return simplest(std::sqrt(real(n)));
    }))};
  }
  if (function == "min" || function == "max") {
    ExpressionValue out = v;
    for (size_t i = 1; i < arguments.size(); i++) out = extreme(function, out, arguments[i]);
    return out;
  }
  return round_to(function, arguments);
}

size_t bytes_of(const ParamValue& value) {
  return std::visit([](const auto& v) { return bytes(v); }, static_cast<const ParamAlternatives&>(value));
}

std::string described(const ExpressionValue& v) {
  struct Describe {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(int64_t n) const { return fmt::format("the number {}", n); }
    std::string operator()(double n) const { return fmt::format("the number {}", n); }
    std::string operator()(const std::string& s) const { return fmt::format("the text '{}'", s); }
    std::string operator()(Size s) const { return fmt::format("the size {}x{}", s.width, s.height); }
    std::string operator()(const Numbers& n) const { return fmt::format("a list of {} numbers", n.size()); }
    std::string operator()(const Texts& t) const { return fmt::format("a list of {} texts", t.size()); }
    std::string operator()(const NumberMap&) const { return "numbers by name"; }
    std::string operator()(const TextMap&) const { return "texts by name"; }
  };
  return std::visit(Describe{}, static_cast<const ParamAlternatives&>(v.value));
}

std::string plain_unit(const std::string& unit) {
  if (unit.find(" or ") != std::string::npos) return "";
  return unit.substr(0, unit.find(' '));
}

}  // namespace terrazzo::expression
