#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "graphs/text/graph.h"

namespace terrazzo {

/// An error or warning about a graph document or an override.
struct Problem {
  Place place;          ///< 0:0 for overrides and whole files
  std::string where;    ///< `node "x", parameter "y"`; may be empty
  std::string message;  ///< what was expected, what was found, the nearest valid choice
  std::string node{};   ///< the node's name, if the problem is about one
  std::string file{};   ///< the file of `place`; empty: the document itself
  std::string code{};   ///< its kind, for programs; see problem_codes
  /// The parameter or port of the node, or else of the graph, or a part of one ("weights.height"), if it is about one.
  std::string parameter{};
  /// The position of the override it is about among those given to load_graph, if it is about one.
  std::optional<size_t> override_position{};
};

/// Sets the node of the problems from position `first` on.
void set_node(std::vector<Problem>& problems, size_t first, const std::string& node);

/// The kinds of problems and warnings: "syntax", "wire", "parameter", ...
const std::vector<std::string>& problem_codes();

/// Sets the code, one of problem_codes, of the problems from position `first` on that have none.
void set_code(std::vector<Problem>& problems, size_t first, const std::string& code);

/// Sets the file of the problems from position `first` on.
void set_file(std::vector<Problem>& problems, size_t first, const std::string& file);

/// `file:line:column: where: message`, without unknown parts.
std::string describe(const std::string& file, const Problem& problem);

/// A problem of a node in a checked graph. `about`: the responsible port, parameter or part of one ("weights.height",
/// "maps.0"); may be empty.
Problem problem_of(const GraphNode& node, const std::string& about, const std::string& message);

/// The most problems that are shown. Only these get suggestions, since searching for them takes time.
inline constexpr size_t most_problems_shown = 100;
/// "and 99,900 more problems"; empty if all are shown.
std::string problems_not_shown(size_t all, const char* what = "problem");

/// All problems of one document, ordered by place. what() has one line for each problem that is shown.
class GraphError : public Error {
 public:
  GraphError(const std::string& file, std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }
  const std::string& file() const { return file_; }

 private:
  struct InOrder {
    std::vector<Problem> problems;
  };
  GraphError(InOrder ordered, const std::string& file);

  std::string file_;
  std::vector<Problem> problems_;
};

}  // namespace terrazzo
