#include "graphs/tools/draw.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "core/base/text.h"
#include "graphs/tools/layout.h"

namespace terrazzo {

namespace {

constexpr double title_height = 40, row_height = 17, title_char = 8.6, port_char = 6.8, padding = 12,
                 legend_height = 26, path_height = 13, line_height = 17, picture_side = 64, stripe_width = 5;
/// The distance between a subgraph's boxes and its frame; the name is above them.
constexpr double frame_gap = 5, frame_title = 13;

/// In the order of ValueType.
constexpr auto wire_colours =
    std::to_array<std::string_view>({"#2f7d32", "#1565c0", "#8e24aa", "#c2185b", "#d84315", "#00838f", "#5d4037"});
static_assert(wire_colours.size() == value_type_names.size(), "wires of each type of value have a colour");

std::string_view box_colour(const NodeType& type) {
  if (type.category == "source") return "#e3f2e1";
  if (type.category == "image") return "#e8eaf6";
  if (type.category == "analysis") return "#f3e5f5";
  if (type.category == "synthesis") return "#fff3e0";
  return type.category == "sink" ? "#eceff1" : "#ffffff";
}

/// One wire by the positions of its nodes in the graph and of its ports in their boxes.
struct DrawnWire {
  size_t from = 0, output = 0, to = 0, input = 0;
  ValueType type = ValueType::image;
};

struct Box {
  std::string path, name;                    ///< the path of its subgraph, "walls/"; its name in there
  std::vector<std::string> inputs, outputs;  ///< the wired ports, in the descriptor's order
  BoxSize size;

  double ports_top() const { return title_height + (path.empty() ? 0 : path_height); }
  /// The position of a port, from the top of the box.
  double row_y(size_t row) const { return ports_top() + row_height * (double(row) + 0.5); }
  double ports_bottom() const { return ports_top() + row_height * double(std::max(inputs.size(), outputs.size())) + 6; }
};

/// The offset of the name within the subgraph. Text in brackets, as in "walls [out=a/b]", is not a path.
size_t path_length(const std::string& name) {
  const size_t slash = name.substr(0, name.find(" [")).rfind('/');
  return slash == name.npos ? 0 : slash + 1;
}

struct Frame {
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  void add(Point corner, BoxSize size) {
    left = std::min(left, corner.x - frame_gap);
    top = std::min(top, corner.y - frame_gap - frame_title);
    right = std::max(right, corner.x + size.width + frame_gap);
    bottom = std::max(bottom, corner.y + size.height + frame_gap);
  }
  bool touches(Point corner, BoxSize size) const {
    return corner.x < right && corner.x + size.width > left && corner.y < bottom && corner.y + size.height > top;
  }
};

size_t position(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

double text_width(const std::vector<std::string>& texts, double per_char) {
  double widest = 0;
  for (const std::string& t : texts) widest = std::max(widest, per_char * double(t.size()));
  return widest;
}

class Drawing {
 public:
  Drawing(const Graph& graph, const std::vector<NodeMark>& marks)
      : graph_(graph), marks_(marks), boxes_(graph.nodes.size()) {
    std::map<std::string, size_t> nodes;
    for (size_t i = 0; i < graph.nodes.size(); i++) nodes.emplace(graph.nodes[i].name, i);
    list_ports(nodes);
    for (size_t i = 0; i < graph.nodes.size(); i++) {
      for (const auto& [port, wires] : graph.nodes[i].inputs) {
        for (const Wire& w : wires) {
          const size_t from = nodes.at(w.node);
          wires_.push_back({from, position(boxes_[from].outputs, w.port), i, position(boxes_[i].inputs, port),
                            graph.nodes[from].type->find_output(w.port)->type});
        }
      }
    }
    measure();
  }

  std::string svg() {
    std::vector<BoxSize> sizes;
    for (const Box& b : boxes_) sizes.push_back(b.size);
    std::vector<LayoutWire> ends;
    for (const DrawnWire& w : wires_)
      ends.push_back({w.from, boxes_[w.from].row_y(w.output), w.to, boxes_[w.to].row_y(w.input)});
    const Layout layout = lay_out(sizes, ends);
    const double width = std::max(layout.width, legend_width()), height = layout.height + legend_height;
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"graph\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
        "{0:.0f} "
        "{1:.0f}\" "
        "font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"11\">\n"
        "<rect class=\"paper\" width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n",
        width, height);
    if (!graph_.summary.empty()) out_ += fmt::format("<title>{}</title>\n", markup(graph_.summary));
    draw_frames(layout);
    for (size_t w = 0; w < wires_.size(); w++) draw_wire(wires_[w], layout.ways[w]);
    for (size_t i = 0; i < boxes_.size(); i++) draw_box(i, layout.corners[i]);
    draw_legend(layout.height);
    return out_ + "</svg>\n";
  }

 private:
  void list_ports(const std::map<std::string, size_t>& nodes) {
    std::vector<std::set<std::string>> read(boxes_.size());
    for (const GraphNode& n : graph_.nodes)
      for (const auto& [port, wires] : n.inputs)
        for (const Wire& w : wires) read[nodes.at(w.node)].insert(w.port);
    for (size_t i = 0; i < boxes_.size(); i++) {
      const GraphNode& n = graph_.nodes[i];
      for (const Port& p : n.type->inputs)
        if (n.inputs.contains(p.name)) boxes_[i].inputs.push_back(p.name);
      for (const Port& p : n.type->outputs)
        if (read[i].contains(p.name)) boxes_[i].outputs.push_back(p.name);
    }
  }

  void measure() {
    for (size_t i = 0; i < boxes_.size(); i++) {
      Box& b = boxes_[i];
      const GraphNode& n = graph_.nodes[i];
      b.path = n.name.substr(0, path_length(n.name));
      b.name = n.name.substr(b.path.size());
      const double titles = std::max(text_width({b.name}, title_char), text_width({b.path, n.type->name}, port_char));
      const double ports = text_width(b.inputs, port_char) + text_width(b.outputs, port_char) + padding;
      b.size.width = std::max(titles, ports) + 2 * padding;
      b.size.height = b.ports_bottom();
      if (marks_.empty()) continue;
      b.size.width = std::max({b.size.width, picture_side + 2 * padding,
                               text_width({marks_[i].line}, port_char) + 2 * padding + stripe_width});
      b.size.height += line_height + (marks_[i].picture.empty() ? 0 : picture_side + 4);
    }
  }

  /// Draws a frame around the nodes of each direct subgraph.
  void draw_frames(const Layout& layout) {
    std::map<std::string, Frame> frames;
    const auto outermost = [&](size_t i) { return boxes_[i].path.substr(0, boxes_[i].path.find('/')); };
    for (size_t i = 0; i < boxes_.size(); i++)
      if (!boxes_[i].path.empty()) frames[outermost(i)].add(layout.corners[i], boxes_[i].size);
    for (const auto& [name, f] : frames) {
      bool is_free = true;
      for (size_t i = 0; i < boxes_.size(); i++)
        is_free &= outermost(i) == name || !f.touches(layout.corners[i], boxes_[i].size);
      if (!is_free) continue;
      out_ += fmt::format(
          "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"8\" "
          "fill=\"#f6f8fa\" stroke=\"#b0bec5\" stroke-dasharray=\"4 3\"/>\n",
          f.left, f.top, f.right - f.left, f.bottom - f.top);
      draw_text(f.left + 8, f.top + 12, "quiet", " font-style=\"italic\"", name);
    }
  }

  void draw_wire(const DrawnWire& wire, const std::vector<Point>& way) {
    std::string path = fmt::format("M{:.1f} {:.1f}", way[0].x, way[0].y);
    for (size_t i = 1; i < way.size(); i++) {
      const Point a = way[i - 1], b = way[i];
      const bool crosses_column = i % 2 == 0;
      const double bend = (b.x - a.x) / 2;
      path += crosses_column ? fmt::format(" H{:.1f}", b.x)
                             : fmt::format(" C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}", a.x + bend, a.y, b.x - bend,
                                           b.y, b.x, b.y);
    }
    const GraphNode &from = graph_.nodes[wire.from], &to = graph_.nodes[wire.to];
    out_ += fmt::format(
        "<path class=\"wire\" d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"><title>{}: {}.{} to "
        "{}.{}</title></path>\n",
        path, wire_colours[size_t(wire.type)], name_of(wire.type), markup(from.name),
        boxes_[wire.from].outputs[wire.output], markup(to.name), boxes_[wire.to].inputs[wire.input]);
  }

  /// `kind`: "strong", "quiet", or "plain", a class and a colour.
  void draw_text(double x, double y, std::string_view kind, std::string_view attributes, const std::string& text) {
    const std::string_view colour = kind == "strong" ? "#202020" : kind == "quiet" ? "#607080" : "#303030";
    out_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\"{}>{}</text>\n", kind, x, y, colour,
                        attributes, markup(text));
  }

  void draw_box(size_t i, Point corner) {
    const Box& b = boxes_[i];
    const GraphNode& n = graph_.nodes[i];
    out_ += fmt::format(
        "<g class=\"node\" data-node=\"{}\"><title>{}</title>\n"
        "<rect class=\"box {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"5\" fill=\"{}\" "
        "stroke=\"#78909c\"/>\n",
        i, markup(n.comment.empty() ? n.name : n.name + ": " + n.comment), n.type->category, corner.x, corner.y,
        b.size.width, b.size.height, box_colour(*n.type));
    double y = corner.y;
    if (!b.path.empty()) {
      draw_text(corner.x + padding, y + 14, "quiet", "", b.path);
      y += path_height;
    }
    draw_text(corner.x + padding, y + 17, "strong", " font-size=\"13\" font-weight=\"bold\"", b.name);
    draw_text(corner.x + padding, y + 32, "quiet", "", n.type->name);
    for (size_t row = 0; row < b.inputs.size(); row++)
      draw_text(corner.x + padding - 3, corner.y + b.row_y(row) + 4, "plain", "", b.inputs[row]);
    for (size_t row = 0; row < b.outputs.size(); row++)
      draw_text(corner.x + b.size.width - padding + 3, corner.y + b.row_y(row) + 4, "plain", " text-anchor=\"end\"",
                b.outputs[row]);
    if (!marks_.empty()) draw_mark(b, marks_[i], corner);
    draw_dots(i, corner);
    out_ += "</g>\n";
  }

  void draw_mark(const Box& b, const NodeMark& mark, Point corner) {
    const std::string_view colour = state_colour(mark.state);
    out_ += fmt::format(
        "<rect class=\"stripe\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" rx=\"2\" fill=\"{}\"/>\n",
        corner.x, corner.y, stripe_width, b.size.height, colour);
    double y = corner.y + b.ports_bottom();
    if (!mark.picture.empty()) {
      out_ += fmt::format("<image x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" href=\"{}\"/>\n",
                          corner.x + (b.size.width - picture_side) / 2, y, picture_side, picture_side, mark.picture);
      y += picture_side + 4;
    }
    out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", corner.x + padding + 3, y + 7,
                        colour);
    draw_text(corner.x + padding + 11, y + 11, "quiet", "", mark.line);
  }

  void draw_dots(size_t i, Point corner) {
    for (const DrawnWire& w : wires_) {
      const auto dot = [&](double x, size_t row) {
        out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x,
                            corner.y + boxes_[i].row_y(row), wire_colours[size_t(w.type)]);
      };
      if (w.from == i) dot(corner.x + boxes_[i].size.width, w.output);
      if (w.to == i) dot(corner.x, w.input);
    }
  }

  std::set<ValueType> used_types() const {
    std::set<ValueType> used;
    for (const DrawnWire& w : wires_) used.insert(w.type);
    return used;
  }
  static double legend_step(ValueType type) { return 34 + port_char * double(name_of(type).size()); }
  double legend_width() const {
    double width = 2 * padding;
    for (const ValueType t : used_types()) width += legend_step(t);
    return width;
  }
  void draw_legend(double y) {
    double x = padding;
    for (const ValueType t : used_types()) {
      out_ += fmt::format("<path d=\"M{:.1f} {:.1f} h16\" stroke=\"{}\" stroke-width=\"2.5\"/>\n", x, y + 6,
                          wire_colours[size_t(t)]);
      draw_text(x + 21, y + 10, "quiet", "", std::string(name_of(t)));
      x += legend_step(t);
    }
  }

  const Graph& graph_;
  const std::vector<NodeMark>& marks_;
  std::vector<Box> boxes_;
  std::vector<DrawnWire> wires_;
  std::string out_;
};

}  // namespace

std::string draw_dot(const Graph& graph) {
  std::string out =
      "digraph terrazzo {\n  rankdir=LR;\n  node [shape=box, style=\"rounded,filled\", fontname=\"sans-serif\"];\n";
  for (const GraphNode& n : graph.nodes)
    out += fmt::format("  \"{}\" [label=\"{}\\n{}\", fillcolor=\"{}\"];\n", n.name, n.name, n.type->name,
                       box_colour(*n.type));
  for (const GraphNode& n : graph.nodes) {
    for (const auto& [port, wires] : n.inputs) {
      for (const Wire& w : wires) {
        const ValueType type = graph.find(w.node)->type->find_output(w.port)->type;
        out += fmt::format("  \"{}\" -> \"{}\" [label=\"{}\", tooltip=\"{}.{} to {}.{}\", color=\"{}\"];\n", w.node,
                           n.name, port, w.node, w.port, n.name, port, wire_colours[size_t(type)]);
      }
    }
  }
  return out + "}\n";
}

std::string draw_svg(const Graph& graph, const std::vector<NodeMark>& marks) {
  return Drawing(graph, marks).svg();
}

std::string_view state_colour(std::string_view state) {
  if (state == "run") return "#e08a00";
  if (state == "cached" || state == "up to date") return "#3f9142";
  if (state == "failed") return "#c62828";
  return "#9aa5ad";
}

}  // namespace terrazzo
