#pragma once

#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/document/load.h"

namespace terrazzo::test {

/// Node types that cover every kind of port and parameter, and stay as they are when real ones are added.
const std::vector<NodeType>& fake_types();

/// Loads a document that uses them; `path` is made up.
LoadedGraph load_fake(const std::string& text, const std::vector<std::string>& overrides = {},
                      const std::string& path = "/project/graphs/test.json");

/// The messages that loading gives; empty if all is well.
std::string problems_of(const std::string& text, const std::vector<std::string>& overrides = {},
                        const std::string& path = "test.json");

/// A document around `nodes`, the inside of the section, and `parameters`.
std::string document(const std::string& nodes, const std::string& parameters = "");

}  // namespace terrazzo::test
