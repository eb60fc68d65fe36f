#include "graphs/values/variations.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/hash.h"
#include "graphs/text/json.h"

namespace terrazzo {

namespace {

[[noreturn]] void too_many() {
  throw Error(fmt::format("more than {} variations; sweep over fewer values", most_variations));
}

/// The beginning of a sweep, for messages; every value of the sweep keeps one.
std::string beginning_of(const std::string& sweep) {
  size_t end = 80;
  if (sweep.size() <= end) return sweep;
  while ((static_cast<unsigned char>(sweep[end]) & 0xC0) == 0x80) end--;
  return sweep.substr(0, end) + "...";
}

/// Splits at commas that are not inside brackets, braces or quotes.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out(1);
  int depth = 0;
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == '[' || c == '{')) depth++;
    if (!quoted && (c == ']' || c == '}')) depth--;
    if (c == ',' && depth == 0 && !quoted)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

bool is_whole_number(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

int64_t integer_in(const std::string& sweep, std::string_view text) {
  int64_t value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc()) return value;
  using Limits = std::numeric_limits<int64_t>;
  throw Error(
      fmt::format("\"{}\": expected integers from {} to {}, found {}", sweep, Limits::min(), Limits::max(), text));
}

/// The exact integers from `first` to `last`; doubles are exact only up to 2^53. `step` has the direction's sign.
/// Computed modulo 2^64, without overflow.
std::vector<std::string> integer_range(int64_t first, int64_t last, int64_t step) {
  const uint64_t distance = last >= first ? uint64_t(last) - uint64_t(first) : uint64_t(first) - uint64_t(last);
  const uint64_t stride = step > 0 ? uint64_t(step) : uint64_t{0} - uint64_t(step);
  if (distance / stride >= most_variations) too_many();
  std::vector<std::string> out;
  for (uint64_t i = 0; i <= distance / stride; i++)
    out.push_back(fmt::format("{}", int64_t(uint64_t(first) + i * uint64_t(step))));
  return out;
}

/// "1..64" or "0..1:0.25"; empty if it is no range.
std::vector<std::string> range_in(const std::string& sweep, const std::string& text) {
  const size_t dots = text.find("..");
  if (dots == text.npos) return {};
  const size_t colon = text.find(':', dots);
  const auto first = number_in(std::string_view(text).substr(0, dots));
  if (const std::string_view rest = std::string_view(text).substr(dots + 2);
      first && rest.starts_with('.') && rest.find_first_not_of("0123456789.:-") == rest.npos)
    throw Error(fmt::format("\"{}\": a range has two dots, as in {}..{}", sweep, text.substr(0, dots),
                            rest.substr(std::min(rest.size(), rest.find_first_not_of('.')))));
  const std::string_view first_text = std::string_view(text).substr(0, dots);
  const std::string_view last_text =
      std::string_view(text).substr(dots + 2, colon == text.npos ? colon : colon - dots - 2);
  const auto last = number_in(last_text);
  if (!first || !last) return {};
  const bool has_step = colon != text.npos;
  const std::string_view step_text = has_step ? std::string_view(text).substr(colon + 1) : "";
  const auto leads_nowhere = [&] {
    return Error(fmt::format("\"{}\": expected a step that leads from {} to {}", sweep, first_text, last_text));
  };
  if (is_whole_number(first_text) && is_whole_number(last_text)) {
    const int64_t from = integer_in(sweep, first_text), to = integer_in(sweep, last_text);
    if (!has_step) return integer_range(from, to, from <= to ? 1 : -1);
    if (is_whole_number(step_text)) {
      const int64_t by = integer_in(sweep, step_text);
      if (by == 0 || (from != to && (from < to) != (by > 0))) throw leads_nowhere();
      return integer_range(from, to, by);
    }
    constexpr double exact = 9007199254740992;  // doubles hold every integer up to here
    if (std::max(std::abs(*first), std::abs(*last)) > exact)
      throw Error(fmt::format("\"{}\": beyond {} a step must be an integer", sweep, int64_t(exact)));
  }
  const auto step = has_step ? number_in(step_text) : std::optional(*first <= *last ? 1.0 : -1.0);
  if (!step || *step == 0 || (*last - *first) * *step < 0) throw leads_nowhere();
  // Each value separately, so that rounding errors do not add up; a last value missed only by rounding counts.
  const double count = std::floor((*last - *first) / *step * (1 + 1e-12)) + 1;
  if (count > double(most_variations)) too_many();
  std::vector<std::string> out;
  for (int i = 0; i < int(count); i++) {
    const double value = *first + i * *step;
    const double rounded = std::round(value * 1e9) / 1e9;
    out.push_back(fmt::format("{}", std::abs(value - rounded) < 1e-11 ? rounded : value));
  }
  return out;
}

/// "1..8" for "1-8" and "1:8"; empty otherwise.
std::string range_meant(const std::string& value) {
  const size_t sign = value.find_first_of("-:", 1);
  if (sign == value.npos) return "";
  const std::string first = value.substr(0, sign), last = value.substr(sign + 1);
  return number_in(first) && number_in(last) ? fmt::format("{}..{}", first, last) : "";
}

/// A digest that is equal for nodes of equal parameters and sources.
Digest signature_of(const GraphNode& node, const std::map<std::string, std::string>& names) {
  Hasher h;
  h.add(node.type->name);
  add_to(h, node.params);
  h.add(int64_t(node.inputs.size()));
  for (const auto& [port, wires] : node.inputs) {
    h.add(port).add(int64_t(wires.size()));
    for (const Wire& w : wires) h.add(names.at(w.node)).add(w.port);
  }
  return h.digest();
}

}  // namespace

std::string Variation::label() const {
  std::vector<std::string> parts;
  for (const auto& [name, value] : values) parts.push_back(name + "=" + value);
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<Override> Variation::overrides() const {
  std::vector<Override> out;
  for (const auto& [name, value] : values) {
    Override& o = out.emplace_back(override_of(name, value));
    const auto origin = origins.find(name);
    if (origin == origins.end()) continue;
    o.where = origin->second.where;
    o.source = {origin->second.file, origin->second.place};
    if (const std::string range = range_meant(value); !range.empty() && o.source.file.empty())
      o.source.advice = fmt::format("; a range is written {}={}", name, range);
  }
  return out;
}

std::vector<Variation> swept(const std::vector<std::string>& sweeps) {
  std::vector<Variation> out;
  std::set<std::string> names;
  for (const std::string& sweep : sweeps) {
    const size_t equals = sweep.find('=');
    const std::string name = sweep.substr(0, equals);
    if (equals == sweep.npos || name.empty() || equals + 1 == sweep.size())
      throw Error(fmt::format("\"{}\": expected name=values, such as seed=1..8 or size=512,1024", sweep));
    if (!names.insert(name).second) throw Error(fmt::format("\"{}\": \"{}\" is swept already", sweep, name));
    std::vector<Variation> values;
    const Variation::Origin origin{"--sweep " + in_quotes(beginning_of(sweep))};
    for (const std::string& part : split(sweep.substr(equals + 1))) {
      const std::vector<std::string> range = range_in(sweep, part);
      if (part.empty()) throw Error(fmt::format("\"{}\": expected a value between commas", sweep));
      if (values.size() + std::max<size_t>(range.size(), 1) > most_variations) too_many();
      for (const std::string& value : range.empty() ? std::vector{part} : range)
        values.push_back({{{name, value}}, {{name, origin}}});
    }
    out = combined(out, values);
  }
  return out;
}

namespace {

std::string described(const Variation::Origin& origin) {
  return origin.file.empty() ? origin.where : fmt::format("{} of {}", origin.where, origin.file);
}

}  // namespace

std::vector<Variation> combined(const std::vector<Variation>& rows, const std::vector<Variation>& columns) {
  if (rows.empty()) return columns;
  if (columns.empty()) return rows;
  if (rows.size() > most_variations / columns.size()) too_many();
  std::vector<Variation> out;
  for (const Variation& row : rows)
    for (const Variation& column : columns) {
      for (const auto& [name, origin] : column.origins)
        if (const auto other = row.origins.find(name); other != row.origins.end())
          throw Error(
              fmt::format("\"{}\" is given twice: by {} and by {}", name, described(other->second), described(origin)));
      out.push_back(row);
      out.back().values.insert(out.back().values.end(), column.values.begin(), column.values.end());
      for (const auto& [name, origin] : column.origins) out.back().origins[name] = origin;
    }
  return out;
}

void GraphMerger::add(Graph graph, const std::string& label) {
  labels_.push_back(label);
  std::map<std::string, std::string>& signatures = signatures_.emplace_back();
  if (labels_.size() == 1) {
    merged_.file = graph.file;
    merged_.summary = graph.summary;
    merged_.settings = graph.settings;
  }
  // Keep settings that are equal in all graphs; the labels show the others.
  std::map<std::string_view, const GraphSetting*> settings;
  for (const GraphSetting& s : graph.settings) settings.emplace(s.name, &s);
  std::erase_if(merged_.settings, [&](const GraphSetting& s) {
    const auto at = settings.find(s.name);
    return at == settings.end() || at->second->value != s.value;
  });
  // Sources come first: nodes with different sources are different.
  for (GraphNode& n : graph.nodes) {
    const std::string signature = signature_of(n, signatures).hex();
    signatures[n.name] = signature;
    if (!made_.emplace(n.name, signature).second) continue;
    kinds_[n.name]++;
    nodes_.push_back({std::move(n), labels_.size() - 1});
  }
}

void GraphMerger::add_again(size_t same) {
  labels_.push_back(labels_.at(same));
  signatures_.push_back(signatures_.at(same));
}

MergedGraph GraphMerger::merged() {
  MergedGraph out{std::move(merged_), {}};
  std::map<std::pair<std::string, std::string>, std::string> names;  // by name and signature
  for (auto& [node, first] : nodes_) {
    const std::string name = kinds_[node.name] == 1 ? node.name : fmt::format("{} [{}]", node.name, labels_[first]);
    names.emplace(std::pair(node.name, signatures_[first].at(node.name)), name);
    for (auto& [port, wires] : node.inputs)
      for (Wire& w : wires) w.node = names.at({w.node, signatures_[first].at(w.node)});
    node.name = name;
    out.graph.nodes.push_back(std::move(node));
  }
  for (const std::map<std::string, std::string>& signatures : signatures_) {
    std::map<std::string, std::string>& own = out.names.emplace_back();
    for (const auto& [name, signature] : signatures) own[name] = names.at({name, signature});
  }
  return out;
}

MergedGraph merged(const std::vector<Graph>& graphs, const std::vector<std::string>& labels) {
  GraphMerger merger;
  for (size_t g = 0; g < graphs.size(); g++) merger.add(graphs[g], labels[g]);
  return merger.merged();
}

}  // namespace terrazzo
