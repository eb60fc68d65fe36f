#include "graphs/document/draw.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "core/base/text.h"
#include "graphs/document/layout.h"

namespace terrazzo {

namespace {

constexpr double title_height = 40, row_height = 17, title_char = 8.2, port_char = 6.6, padding = 12,
                 legend_height = 26;

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

/// One wire by positions: of nodes in the graph, of ports in the lists of their boxes.
struct DrawnWire {
  size_t from = 0, output = 0, to = 0, input = 0;
  ValueType type = ValueType::image;
};

struct Box {
  std::vector<std::string> inputs, outputs;  ///< the wired ones, in the descriptor's order
  BoxSize size;
};

size_t position(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

double row_y(size_t row) {
  return title_height + row_height * (double(row) + 0.5);
}

double text_width(const std::vector<std::string>& texts, double per_char) {
  double widest = 0;
  for (const std::string& t : texts) widest = std::max(widest, per_char * double(t.size()));
  return widest;
}

class Drawing {
 public:
  explicit Drawing(const Graph& graph) : graph_(graph), boxes_(graph.nodes.size()) {
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
    for (const DrawnWire& w : wires_) ends.push_back({w.from, row_y(w.output), w.to, row_y(w.input)});
    const Layout layout = lay_out(sizes, ends);
    const double width = std::max(layout.width, legend_width()), height = layout.height + legend_height;
    out_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" "
        "font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"11\">\n"
        "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n",
        width, height);
    if (!graph_.summary.empty()) out_ += fmt::format("<title>{}</title>\n", markup(graph_.summary));
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
      const double titles = std::max(text_width({n.name}, title_char), text_width({n.type->name}, port_char));
      const double ports = text_width(b.inputs, port_char) + text_width(b.outputs, port_char) + padding;
      b.size.width = std::max(titles, ports) + 2 * padding;
      b.size.height = title_height + row_height * double(std::max(b.inputs.size(), b.outputs.size())) + 6;
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
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"><title>{}: {}.{} to {}.{}</title></path>\n",
        path, wire_colours[size_t(wire.type)], name_of(wire.type), markup(from.name),
        boxes_[wire.from].outputs[wire.output], markup(to.name), boxes_[wire.to].inputs[wire.input]);
  }

  void draw_text(double x, double y, std::string_view attributes, const std::string& text) {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x, y, attributes, markup(text));
  }

  void draw_box(size_t i, Point corner) {
    const Box& b = boxes_[i];
    const GraphNode& n = graph_.nodes[i];
    out_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"5\" fill=\"{}\" "
        "stroke=\"#78909c\"/>\n",
        corner.x, corner.y, b.size.width, b.size.height, box_colour(*n.type));
    draw_text(corner.x + padding, corner.y + 17, " font-size=\"13\" font-weight=\"bold\" fill=\"#202020\"", n.name);
    draw_text(corner.x + padding, corner.y + 32, " fill=\"#607080\"", n.type->name);
    for (size_t row = 0; row < b.inputs.size(); row++)
      draw_text(corner.x + padding - 3, corner.y + row_y(row) + 4, " fill=\"#303030\"", b.inputs[row]);
    for (size_t row = 0; row < b.outputs.size(); row++)
      draw_text(corner.x + b.size.width - padding + 3, corner.y + row_y(row) + 4,
                " fill=\"#303030\" text-anchor=\"end\"", b.outputs[row]);
    draw_dots(i, corner);
  }

  void draw_dots(size_t i, Point corner) {
    for (const DrawnWire& w : wires_) {
      const auto dot = [&](double x, size_t row) {
        out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, corner.y + row_y(row),
                            wire_colours[size_t(w.type)]);
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
      draw_text(x + 21, y + 10, " fill=\"#607080\"", std::string(name_of(t)));
      x += legend_step(t);
    }
  }

  const Graph& graph_;
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

std::string draw_svg(const Graph& graph) {
  return Drawing(graph).svg();
}

}  // namespace terrazzo
