#include "tests/graphs/document/fake_types.h"

namespace terrazzo::test {

namespace {

NodeType photo() {
  NodeType t;
  t.name = "photo";
  t.category = "source";
  t.summary = "Reads a picture";
  t.help = "A made-up source. It reads one picture & says what it means, <nothing> more.";
  t.outputs = {{.name = "image", .type = ValueType::image, .help = "the picture"}};
  t.params = {{.name = "file", .type = ParamType::path, .help = "The picture's file."},
              {.name = "kind",
               .type = ParamType::choice,
               .fallback = "color",
               .help = "What it shows.",
               .choices = {"color", "normal", "height"}}};
  return t;
}

NodeType adjust() {
  NodeType t;
  t.name = "adjust";
  t.category = "image";
  t.summary = "Changes a picture";
  t.inputs = {{.name = "image", .type = ValueType::image, .help = "the picture"},
              {.name = "mask", .type = ValueType::image, .help = "where", .optional = true}};
  t.outputs = {{.name = "image", .type = ValueType::image, .help = "the result"}};
  t.params = {{.name = "amount", .type = ParamType::number, .fallback = 0.5, .help = "How much.", .min = 0, .max = 1},
              {.name = "steps", .type = ParamType::integer, .fallback = int64_t{4}, .help = "How often.", .min = 1},
              {.name = "size",
               .type = ParamType::size,
               .fallback = Size{256, 128},
               .help = "How large.",
               .min = 16,
               .max = 65536,
               .unit = "pixels"},
              {.name = "wrap", .type = ParamType::boolean, .fallback = false, .help = "Whether it tiles."},
              {.name = "label", .type = ParamType::text, .fallback = "", .help = "A name."},
              {.name = "low", .type = ParamType::number, .fallback = 0.0, .help = "The lower end."},
              {.name = "high", .type = ParamType::number, .fallback = 1.0, .help = "The upper end."},
              {.name = "config", .type = ParamType::path, .fallback = "", .help = "A file, or nothing."}};
  t.check = [](const Params& p) -> std::vector<std::string> {
    if (std::get<double>(p.at("low")) < std::get<double>(p.at("high"))) return {};
    return {"\"low\" must be less than \"high\""};
  };
  return t;
}

NodeType gather() {
  NodeType t;
  t.name = "gather";
  t.category = "analysis";
  t.summary = "Gathers pictures into a material";
  t.inputs = {{.name = "images", .type = ValueType::image, .help = "the pictures", .list = true},
              {.name = "extra", .type = ValueType::material, .help = "more", .optional = true, .list = true}};
  t.outputs = {{.name = "material", .type = ValueType::material, .help = "all of them"},
               {.name = "report", .type = ValueType::report, .help = "figures"}};
  t.params = {
      {.name = "channels",
       .type = ParamType::text_map,
       .fallback = TextMap{},
       .help = "Channels by name.",
       .choices = {"r", "g", "b", "a"}},
      {.name = "gains", .type = ParamType::number_map, .fallback = NumberMap{}, .help = "Gains by name.", .min = 0},
      {.name = "names",
       .type = ParamType::texts,
       .fallback = Texts{"a"},
       .help = "Names.",
       .min_count = 1,
       .max_count = 3},
      {.name = "weights",
       .type = ParamType::numbers,
       .fallback = Numbers{1, 2},
       .help = "Weights.",
       .min = 0,
       .max = 10,
       .min_count = 2,
       .max_count = 4}};
  return t;
}

NodeType write() {
  NodeType t;
  t.name = "write";
  t.category = "sink";
  t.summary = "Writes a material";
  t.inputs = {{.name = "material", .type = ValueType::material, .help = "what is written"}};
  t.params = {{.name = "path", .type = ParamType::path, .help = "The files' pattern."},
              {.name = "quality",
               .type = ParamType::integer,
               .fallback = int64_t{90},
               .help = "How good.",
               .min = 1,
               .max = 100,
               .unit = "percent"}};
  return t;
}

}  // namespace

const std::vector<NodeType>& fake_types() {
  static const std::vector<NodeType> types = {photo(), adjust(), gather(), write()};
  return types;
}

LoadedGraph load_fake(const std::string& text, const std::vector<std::string>& overrides, const std::string& path) {
  return load_graph_text(text, path, overrides_from(overrides), {.types = fake_types()});
}

std::string problems_of(const std::string& text, const std::vector<std::string>& overrides, const std::string& path) {
  try {
    load_fake(text, overrides, path);
  } catch (const GraphError& e) {
    return e.what();
  }
  return "";
}

std::string document(const std::string& nodes, const std::string& parameters) {
  return "{\"terrazzo\": 1, \"parameters\": {" + parameters + "}, \"nodes\": {" + nodes + "}}";
}

}  // namespace terrazzo::test
