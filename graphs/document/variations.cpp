#include "graphs/document/variations.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/hash.h"
#include "graphs/document/json.h"
#include "graphs/document/override.h"

namespace terrazzo {

namespace {

[[noreturn]] void too_many() {
  throw Error(fmt::format("more than {} variations; sweep over fewer values", most_variations));
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
  const auto last = number_in(std::string_view(text).substr(dots + 2, colon == text.npos ? colon : colon - dots - 2));
  if (!first || !last) return {};
  const auto step = colon == text.npos ? std::optional(*first <= *last ? 1.0 : -1.0)
                                       : number_in(std::string_view(text).substr(colon + 1));
  if (!step || *step == 0 || (*last - *first) * *step < 0)
    throw Error(fmt::format("\"{}\": expected a step that leads from {} to {}", sweep, *first, *last));
  // Each value by itself, so that rounding does not add up; a last value that is missed by rounding alone counts.
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

/// Parameters into a digest that is equal for equal nodes.
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

std::vector<std::string> Variation::overrides() const {
  std::vector<std::string> out;
  for (const auto& [name, value] : values) out.push_back(name + "=" + value);
  return out;
}

namespace {

/// "1..8" of "1-8" and "1:8"; empty of others.
std::string range_meant(const std::string& value) {
  const size_t sign = value.find_first_of("-:", 1);
  if (sign == value.npos) return "";
  const std::string first = value.substr(0, sign), last = value.substr(sign + 1);
  return number_in(first) && number_in(last) ? fmt::format("{}..{}", first, last) : "";
}

}  // namespace

std::vector<Problem> with_origins(std::vector<Problem> problems, const Variation& variation) {
  for (const auto& [name, value] : variation.values) {
    const auto origin = variation.origins.find(name);
    if (origin == variation.origins.end()) continue;
    for (Problem& p : problems) {
      if (p.where != where_of_override(name + "=" + value)) continue;
      p.where = origin->second.where;
      p.file = origin->second.file;
      p.place = origin->second.place;
      if (const std::string range = range_meant(value); !range.empty() && p.file.empty())
        p.message += fmt::format("; a range is written {}={}", name, range);
    }
  }
  return problems;
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
    const Variation::Origin origin{"--sweep " + in_quotes(sweep)};
    for (const std::string& part : split(sweep.substr(equals + 1))) {
      const std::vector<std::string> range = range_in(sweep, part);
      if (part.empty()) throw Error(fmt::format("\"{}\": expected a value between commas", sweep));
      for (const std::string& value : range.empty() ? std::vector{part} : range)
        values.push_back({{{name, value}}, {{name, origin}}});
    }
    out = combined(out, values);
  }
  return out;
}

std::vector<Variation> combined(const std::vector<Variation>& rows, const std::vector<Variation>& columns) {
  if (rows.empty()) return columns;
  if (columns.empty()) return rows;
  if (rows.size() > most_variations / columns.size()) too_many();
  std::vector<Variation> out;
  for (const Variation& row : rows)
    for (const Variation& column : columns) {
      out.push_back(row);
      out.back().values.insert(out.back().values.end(), column.values.begin(), column.values.end());
      for (const auto& [name, origin] : column.origins) out.back().origins[name] = origin;
    }
  return out;
}

namespace {

/// What is set alike in all of them; the others' values are in the labels.
std::vector<GraphSetting> shared_settings(const std::vector<Graph>& graphs) {
  std::vector<GraphSetting> out = graphs.front().settings;
  for (const Graph& g : graphs)
    std::erase_if(out, [&](const GraphSetting& s) {
      const auto at = std::ranges::find(g.settings, s.name, &GraphSetting::name);
      return at == g.settings.end() || at->value != s.value;
    });
  return out;
}

}  // namespace

MergedGraph merged(const std::vector<Graph>& graphs, const std::vector<std::string>& labels) {
  MergedGraph out;
  out.names.resize(graphs.size());
  if (graphs.empty()) return out;
  out.graph.file = graphs.front().file;
  out.graph.summary = graphs.front().summary;
  out.graph.settings = shared_settings(graphs);
  // Nodes that are not alike in all variations, found in the order of wires: what reads them is not alike either.
  std::map<std::string, std::set<std::string>> signatures;
  std::vector<std::map<std::string, std::string>> unlike(graphs.size());
  for (size_t g = 0; g < graphs.size(); g++)
    for (const GraphNode& n : graphs[g].nodes) {
      const std::string signature = signature_of(n, unlike[g]).hex();
      unlike[g][n.name] = signature;
      signatures[n.name].insert(signature);
    }
  std::map<std::pair<std::string, std::string>, std::string> made;  // by name and signature
  for (size_t g = 0; g < graphs.size(); g++)
    for (const GraphNode& n : graphs[g].nodes) {
      const auto [at, is_new] = made.try_emplace({n.name, unlike[g].at(n.name)});
      if (is_new) {
        at->second = signatures[n.name].size() == 1 ? n.name : fmt::format("{} [{}]", n.name, labels[g]);
        GraphNode copy = n;
        copy.name = at->second;
        for (auto& [port, wires] : copy.inputs)
          for (Wire& w : wires) w.node = out.names[g].at(w.node);
        out.graph.nodes.push_back(std::move(copy));
      }
      out.names[g][n.name] = at->second;
    }
  return out;
}

}  // namespace terrazzo
