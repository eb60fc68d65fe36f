#include "graphs/tools/layout.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace terrazzo {

namespace {

constexpr double column_gap = 64, row_gap = 18, margin = 20, passage = 6;
constexpr int sweeps = 12;

/// A box, or the passage of wires through a column between boxes.
struct Cell {
  size_t column = 0;
  double width = 0, height = 0;
  double x = 0, y = 0;
};

/// A piece of wire between neighbouring columns.
struct Link {
  size_t left, right;
  double left_y, right_y;  ///< from the top of the cell
};

class Placer {
 public:
  Placer(const std::vector<BoxSize>& boxes, const std::vector<LayoutWire>& wires) : boxes_(boxes), wires_(wires) {
    assign_columns();
    add_passages();
    order_columns();
    place();
  }

  Layout layout() const {
    Layout out;
    for (size_t i = 0; i < boxes_.size(); i++) out.corners.push_back({cells_[i].x, cells_[i].y});
    for (const Cell& c : cells_) {
      out.width = std::max(out.width, c.x + c.width + margin);
      out.height = std::max(out.height, c.y + c.height + margin);
    }
    for (size_t w = 0; w < wires_.size(); w++) out.ways.push_back(way_of(w));
    return out;
  }

 private:
  void assign_columns() {
    const size_t unread = boxes_.size();
    std::vector<bool> has_input(boxes_.size());
    for (const BoxSize& b : boxes_) cells_.push_back({.width = b.width, .height = b.height});
    std::vector<std::vector<size_t>> readers(boxes_.size());
    for (const LayoutWire& w : wires_) {
      readers[w.from].push_back(w.to);
      has_input[w.to] = true;
    }
    for (size_t i = 0; i < boxes_.size(); i++)
      for (const size_t r : readers[i]) cells_[r].column = std::max(cells_[r].column, cells_[i].column + 1);
    // Sources are placed next to their first reader, not at the far left.
    for (size_t i = 0; i < boxes_.size(); i++) {
      size_t first = unread;
      for (const size_t r : readers[i]) first = std::min(first, cells_[r].column);
      if (!has_input[i] && first != unread) cells_[i].column = first - 1;
    }
  }

  /// Wires from the same output share their passages.
  void add_passages() {
    std::map<std::tuple<size_t, double, size_t>, size_t> passages;
    via_.resize(wires_.size());
    for (size_t w = 0; w < wires_.size(); w++) {
      const LayoutWire& wire = wires_[w];
      size_t last = wire.from;
      double last_y = wire.from_y;
      for (size_t column = cells_[wire.from].column + 1; column < cells_[wire.to].column; column++) {
        const auto [at, is_new] = passages.try_emplace({wire.from, wire.from_y, column}, cells_.size());
        if (is_new) {
          cells_.push_back({.column = column, .height = passage});
          links_.push_back({last, at->second, last_y, passage / 2});
        }
        via_[w].push_back(at->second);
        last = at->second;
        last_y = passage / 2;
      }
      links_.push_back({last, wire.to, last_y, wire.to_y});
    }
    before_.resize(cells_.size());
    after_.resize(cells_.size());
    for (const Link& l : links_) {
      before_[l.right].push_back(l);
      after_[l.left].push_back(l);
    }
    for (size_t i = 0; i < cells_.size(); i++) {
      columns_.resize(std::max(columns_.size(), cells_[i].column + 1));
      columns_[cells_[i].column].push_back(i);
    }
  }

  /// Sorts each column by the positions of its neighbours in the previous (or next) column.
  void order_columns() {
    std::vector<double> rank(cells_.size());
    const auto renumber = [&](const std::vector<size_t>& column) {
      for (size_t i = 0; i < column.size(); i++) rank[column[i]] = double(i);
    };
    for (const std::vector<size_t>& column : columns_) renumber(column);
    for (int sweep = 0; sweep < sweeps; sweep++) {
      const bool forward = sweep % 2 == 0;
      for (size_t n = 0; n < columns_.size(); n++) {
        std::vector<size_t>& column = columns_[forward ? n : columns_.size() - 1 - n];
        std::map<size_t, double> wish;
        for (const size_t cell : column) wish[cell] = mean_rank(cell, forward, rank);
        std::stable_sort(column.begin(), column.end(), [&](size_t a, size_t b) { return wish[a] < wish[b]; });
        renumber(column);
      }
    }
  }

  double mean_rank(size_t cell, bool forward, const std::vector<double>& rank) const {
    const std::vector<Link>& links = forward ? before_[cell] : after_[cell];
    if (links.empty()) return rank[cell];
    double sum = 0;
    for (const Link& l : links) {
      const size_t other = forward ? l.left : l.right;
      const double offset = forward ? l.left_y : l.right_y;
      sum += rank[other] + offset / (cells_[other].height + 1);
    }
    return sum / double(links.size());
  }

  void place() {
    double x = margin;
    for (const std::vector<size_t>& column : columns_) {
      double width = 0, y = margin;
      for (const size_t cell : column) width = std::max(width, cells_[cell].width);
      for (const size_t cell : column) {
        Cell& c = cells_[cell];
        const bool is_passage = cell >= boxes_.size();
        if (is_passage) c.width = width;
        c.x = x + (width - c.width) / 2;
        c.y = y;
        y += c.height + row_gap;
      }
      x += width + column_gap;
    }
    for (int sweep = 0; sweep < sweeps; sweep++)
      for (size_t n = 0; n < columns_.size(); n++) straighten(columns_[sweep % 2 == 0 ? n : columns_.size() - 1 - n]);
    if (cells_.empty()) return;
    const auto higher = [](const Cell& a, const Cell& b) { return a.y < b.y; };
    const double top = std::min_element(cells_.begin(), cells_.end(), higher)->y;
    for (Cell& c : cells_) c.y += margin - top;
  }

  /// Moves a column's cells to the positions that their wires prefer, subject to their order and gaps. Pooling
  /// overlapping neighbours minimises the squared deviation.
  void straighten(const std::vector<size_t>& column) {
    struct Block {
      double sum;
      size_t count;
    };
    std::vector<Block> blocks;
    double offset = 0;
    std::vector<double> offsets;
    for (const size_t cell : column) {
      offsets.push_back(offset);
      blocks.push_back({wished_y(cell) - offset, 1});
      offset += cells_[cell].height + row_gap;
      const auto mean = [](const Block& b) { return b.sum / double(b.count); };
      while (blocks.size() > 1 && mean(blocks[blocks.size() - 2]) > mean(blocks.back())) {
        const Block last = blocks.back();
        blocks.pop_back();
        blocks.back() = {blocks.back().sum + last.sum, blocks.back().count + last.count};
      }
    }
    size_t next = 0;
    for (const Block& b : blocks)
      for (size_t i = 0; i < b.count; i++, next++) cells_[column[next]].y = b.sum / double(b.count) + offsets[next];
  }

  double wished_y(size_t cell) const {
    double sum = 0;
    for (const Link& l : before_[cell]) sum += cells_[l.left].y + l.left_y - l.right_y;
    for (const Link& l : after_[cell]) sum += cells_[l.right].y + l.right_y - l.left_y;
    const size_t count = before_[cell].size() + after_[cell].size();
    return count == 0 ? cells_[cell].y : sum / double(count);
  }

  std::vector<Point> way_of(size_t w) const {
    const Cell& from = cells_[wires_[w].from];
    const Cell& to = cells_[wires_[w].to];
    std::vector<Point> way = {{from.x + from.width, from.y + wires_[w].from_y}};
    for (const size_t cell : via_[w]) {
      const Cell& c = cells_[cell];
      way.push_back({c.x, c.y + passage / 2});
      way.push_back({c.x + c.width, c.y + passage / 2});
    }
    way.push_back({to.x, to.y + wires_[w].to_y});
    return way;
  }

  const std::vector<BoxSize>& boxes_;
  const std::vector<LayoutWire>& wires_;
  std::vector<Cell> cells_;  ///< boxes first
  std::vector<Link> links_;
  std::vector<std::vector<Link>> before_, after_;
  std::vector<std::vector<size_t>> columns_;
  std::vector<std::vector<size_t>> via_;
};

}  // namespace

Layout lay_out(const std::vector<BoxSize>& boxes, const std::vector<LayoutWire>& wires) {
  return Placer(boxes, wires).layout();
}

}  // namespace terrazzo
