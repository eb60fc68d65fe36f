#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "graphs/document/load.h"
#include "tests/golden/record.h"
#include "tests/run_node.h"

namespace terrazzo::test {

/// A graph whose nodes are the cases.
struct GoldenDocument {
  std::string name;  ///< in the golden files
  std::filesystem::path graph;
  std::vector<std::string> settings;  ///< name=value, with {in} and {out} for the session's folders
  bool stock = false;                 ///< a graph that comes with the program; its lines are in graphs.txt
};

/// Groups of documents that run together, in an order in which later ones may read what earlier ones have written.
std::vector<std::string> golden_groups();
std::vector<GoldenDocument> documents_of(const std::string& group);

/// The golden file, without its ending, that a node's lines are in.
std::string file_of(const GoldenDocument& document, const NodeType& type);

/// What came out of one node.
struct GoldenCase {
  std::string file;                             ///< of its lines
  std::vector<GoldenLine> lines;                ///< one for each output or written file
  std::vector<Wire> sources;                    ///< whose outputs went in
  std::vector<std::filesystem::path> files_in;  ///< that it read
  std::vector<std::filesystem::path> files_out;
  bool decided = false;  ///< analysis or synthesis, or comes after it
};

/// Runs documents in a folder of its own with the golden inputs. Results do not depend on where that is, nor on whether
/// TERRAZZO_GOLDEN_OLDEST asks for the least of the instruction sets.
class GoldenSession {
 public:
  GoldenSession();
  LoadedGraph load(const GoldenDocument& document) const;
  /// The cases in topological order. Fails the test if a node fails.
  std::vector<GoldenCase> run(const GoldenDocument& document) const;

 private:
  std::filesystem::path out_of(const GoldenDocument& document) const;
  TemporaryFolder folder_;
};

}  // namespace terrazzo::test
