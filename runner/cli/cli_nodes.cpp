#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/tools/reference.h"
#include "graphs/tools/schema.h"
#include "nodes/common/registry.h"
#include "runner/cli/cli_commands.h"
#include "runner/terminal/console.h"

namespace terrazzo {

namespace {

std::vector<std::string> type_names() {
  std::vector<std::string> out;
  for (const NodeType& t : node_types()) out.push_back(t.name);
  return out;
}

const NodeType& known_type(const std::string& name) {
  if (const NodeType* type = find_node_type(name)) return *type;
  throw UsageError(fmt::format("there is no node type \"{}\"{}", name, suggestion(name, type_names())));
}

int show_nodes(const std::string& name, bool json) {
  if (name.empty())
    print_result("{}", json ? nodes_json() : node_list());
  else if (json)
    print_result("{}", nodes_json({known_type(name)}));
  else
    print_result("{}", node_reference(known_type(name)));
  return exit_done;
}

}  // namespace

void add_node_commands(Command& program) {
  Command& nodes = program.add_command("nodes", "Lists the node types, or describes one");
  struct Flags {
    std::string type;
    bool json = false;
  };
  const auto flags = std::make_shared<Flags>();
  nodes.add_option("TYPE", &flags->type, "The node type to describe").takes("").suggests(type_names());
  nodes.add_flag("--json", &flags->json, "For programs: an array of descriptors");
  nodes.footer = "Examples:\n  terrazzo nodes\n  terrazzo nodes synthesize";
  nodes.run = [flags] { return show_nodes(flags->type, flags->json); };

  Command& schema = program.add_command("schema", "Prints the JSON Schema of graph files, for editors");
  schema.footer = "Example:\n  terrazzo schema > terrazzo.schema.json";
  schema.run = [] {
    print_result("{}", json_schema());
    return exit_done;
  };
}

}  // namespace terrazzo
