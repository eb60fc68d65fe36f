#include "runner/editor/arrangement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/node/node.h"
#include "graphs/edit/edit_context.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/tools/layout.h"
#include "nodes/common/registry.h"

namespace terrazzo {

namespace {

// As in the page's canvas/model.ts and canvas.css.
constexpr double card_width = 176, bare_height = 49, port_height = 17, picture_height = 96;
constexpr double room_beside = 56, room_below = 20, middle_of_head = 12;

size_t member_count(const JsonValue& graph, const char* section) {
  const JsonValue* all = graph.find(section);
  return all ? all->members.size() : 0;
}

size_t rows_of_graph(const JsonValue& graph) {
  return std::max(member_count(graph, "inputs"), member_count(graph, "outputs"));
}

/// By type: how many rows of ports a card has.
const std::map<std::string, size_t, std::less<>>& known_rows() {
  static const auto all = [] {
    std::map<std::string, size_t, std::less<>> out;
    for (const NodeType& t : node_types()) out.emplace(t.name, std::max(t.inputs.size(), t.outputs.size()));
    for (const StockGraph& g : stock_graphs())
      if (const ParsedJson parsed = parse_json(g.text); parsed.value)
        out.emplace("stock:" + std::string(g.name), rows_of_graph(*parsed.value));
    return out;
  }();
  return all;
}

double height_of(const JsonValue& document, const JsonValue& node, size_t sources) {
  size_t rows = std::max<size_t>(1, sources);  // of a type that is not known here
  const JsonValue* type = node.find("type");
  const JsonValue* graphs = document.find("graphs");
  if (type && type->is_text()) {
    if (const JsonValue* graph = graphs ? graphs->find(type->text) : nullptr)
      rows = rows_of_graph(*graph);
    else if (const auto at = known_rows().find(type->text); at != known_rows().end())
      rows = at->second;
  }
  return bare_height + port_height * double(rows);
}

/// Where a row of columns ends so that few wires go on in the next: the first column behind it.
std::vector<size_t> row_ends(size_t columns, size_t rows, const std::vector<size_t>& crossing) {
  constexpr size_t reach = 1;  // columns to either side of even rows
  std::vector<size_t> out;
  for (size_t r = 1; r < rows; r++) {
    const size_t even = r * columns / rows;
    size_t best = even;
    for (size_t end = even - reach; end <= even + reach; end++)
      if (end > (out.empty() ? 0 : out.back()) && end < columns && crossing[end] < crossing[best]) best = end;
    out.push_back(best);
  }
  out.push_back(columns);
  return out;
}

/// Puts a long row of columns into several, one below the other, about twice as wide as high in all.
void wrap(std::vector<Point>& corners, const std::vector<BoxSize>& boxes, const std::vector<LayoutWire>& wires) {
  constexpr size_t most_columns = 8, fewest_in_row = 4;
  constexpr double between_rows = 72, shape = 2, too_long = 4;
  std::map<double, size_t> columns;
  for (const Point& p : corners) columns.emplace(p.x, 0);
  for (size_t n = 0; auto& [x, index] : columns) index = n++;
  if (columns.size() <= most_columns) return;
  const double left = columns.begin()->first, width = columns.rbegin()->first + card_width - left;
  double top = corners.front().y, bottom = top;
  for (size_t i = 0; i < corners.size(); i++)
    top = std::min(top, corners[i].y), bottom = std::max(bottom, corners[i].y + boxes[i].height);
  if (width < too_long * (bottom - top)) return;
  const size_t wanted = size_t(std::lround(std::sqrt(width / (shape * (bottom - top + between_rows)))));
  const size_t rows = std::clamp<size_t>(wanted, 1, columns.size() / fewest_in_row);
  std::vector<size_t> crossing(columns.size() + 1);  // by column: wires that come from before it
  for (const LayoutWire& w : wires)
    for (size_t c = columns[corners[w.from].x] + 1; c <= columns[corners[w.to].x]; c++) crossing[c]++;
  std::vector<Point> moved = corners;
  double y = top;
  size_t first = 0;
  for (const size_t end : row_ends(columns.size(), rows, crossing)) {
    double own_top = bottom, own_bottom = top, own_left = left + width;
    std::vector<size_t> own;
    for (size_t i = 0; i < corners.size(); i++)
      if (const size_t c = columns[corners[i].x]; c >= first && c < end) {
        own.push_back(i);
        own_left = std::min(own_left, corners[i].x);
        own_top = std::min(own_top, corners[i].y);
        own_bottom = std::max(own_bottom, corners[i].y + boxes[i].height);
      }
    for (const size_t i : own) moved[i] = {corners[i].x - own_left + left, corners[i].y - own_top + y};
    y += own_bottom - own_top + between_rows;
    first = end;
  }
  corners = std::move(moved);
}

}  // namespace

Arrangement::Arrangement(const JsonValue& document, const JsonValue& nodes) {
  for (const JsonMember& m : nodes.members) positions_.emplace(m.name, names_.size()), names_.push_back(m.name);
  sources_.resize(names_.size());
  for (const JsonMember& m : nodes.members) {
    const size_t i = positions_.at(m.name);
    for (const std::string& named : edits::named_nodes(m.value))
      if (const auto at = positions_.find(named); at != positions_.end() && at->second != i)
        sources_[i].push_back(at->second);
    heights_.push_back(height_of(document, m.value, sources_[i].size()));
  }
  sort();
}

Arrangement::Positions Arrangement::automatic() const {
  std::vector<size_t> rank(names_.size());
  for (size_t k = 0; k < order_.size(); k++) rank[order_[k]] = k;
  std::vector<BoxSize> boxes;
  std::vector<LayoutWire> wires;
  for (const size_t i : order_) boxes.push_back({card_width, heights_[i]});
  for (const size_t i : order_)
    for (const size_t source : sources_[i])
      if (rank[source] < rank[i]) wires.push_back({rank[source], middle_of_head, rank[i], middle_of_head});
  Layout layout = lay_out(boxes, wires);
  if (!boxes.empty()) wrap(layout.corners, boxes, wires);
  Positions out;
  for (size_t k = 0; k < order_.size(); k++)
    out[names_[order_[k]]] = {std::round(layout.corners[k].x), std::round(layout.corners[k].y), false};
  return out;
}

Arrangement::Positions Arrangement::completed(Positions known) const {
  if (std::ranges::all_of(names_, [&](const std::string& n) { return known.contains(n); })) return known;
  if (known.empty()) return automatic();
  std::optional<Positions> all;  // takes a while
  for (const size_t i : order_) {
    if (known.contains(names_[i])) continue;
    NodePlace place;
    bool has_source = false;
    for (const size_t s : sources_[i]) {
      const auto at = known.find(names_[s]);
      if (at == known.end() || (has_source && at->second.x + card_width + room_beside <= place.x)) continue;
      place = {at->second.x + card_width + room_beside, at->second.y, false};
      has_source = true;
    }
    if (!has_source) {
      if (!all) all = automatic();
      place = all->at(names_[i]);
    }
    known[names_[i]] = free_place(place, i, known);
  }
  return known;
}

double Arrangement::way_down(const NodePlace& place, size_t node, const Positions& others) const {
  for (const auto& [name, other] : others) {
    const auto at = positions_.find(name);
    const double bottom = other.y + (at == positions_.end() ? bare_height : heights_[at->second]) +
                          (other.pinned ? picture_height : 0) + room_below;
    if (std::abs(other.x - place.x) < card_width && place.y < bottom && other.y < place.y + heights_[node] + room_below)
      return bottom - place.y;
  }
  return 0;
}

NodePlace Arrangement::free_place(NodePlace place, size_t node, const Positions& known) const {
  for (size_t tries = 0; tries <= known.size(); tries++) {
    const double down = way_down(place, node, known);
    if (down == 0) break;
    place.y += down;
  }
  return place;
}

Arrangement::Positions Arrangement::clear_of(Positions block, const Positions& others) const {
  for (size_t tries = 0; tries <= others.size() * block.size(); tries++) {
    double down = 0;
    for (const auto& [name, place] : block)
      if (const auto at = positions_.find(name); at != positions_.end())
        down = std::max(down, way_down(place, at->second, others));
    if (down == 0) break;
    for (auto& entry : block) entry.second.y += down;
  }
  return block;
}

void Arrangement::sort() {
  enum class State : uint8_t { unseen, open, done };
  std::vector<State> state(names_.size(), State::unseen);
  for (size_t start = 0; start < names_.size(); start++) {
    if (state[start] != State::unseen) continue;
    std::vector<std::pair<size_t, size_t>> path = {{start, 0}};
    state[start] = State::open;
    while (!path.empty()) {
      auto& [node, next] = path.back();
      if (next == sources_[node].size()) {
        state[node] = State::done;
        order_.push_back(node);
        path.pop_back();
      } else if (const size_t source = sources_[node][next++]; state[source] == State::unseen) {
        state[source] = State::open;
        path.emplace_back(source, 0);
      }
    }
  }
}

}  // namespace terrazzo
