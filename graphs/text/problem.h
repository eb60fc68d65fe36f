#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "graphs/text/graph.h"

namespace terrazzo {

/// Something wrong in a graph document or in an override.
struct Problem {
  Place place;          ///< 0:0 for overrides and whole files
  std::string where;    ///< `node "x", parameter "y"`; may be empty
  std::string message;  ///< what was expected, what was found, the nearest valid choice
  std::string node{};   ///< the node's name, if it is about one
  std::string file{};   ///< the file that `place` is in; empty: the document itself
  std::string code{};   ///< its kind, for programs: see problem_codes
};

/// Tells them that they are about this node.
void set_node(std::vector<Problem>& problems, size_t first, const std::string& node);

/// The kinds of problems and warnings: "syntax", "wire", "parameter", ...
const std::vector<std::string>& problem_codes();

/// Gives the problems from position `first` on this code, but for those that have one. It must be one of problem_codes.
void set_code(std::vector<Problem>& problems, size_t first, const std::string& code);

/// Tells the problems from position `first` on that their places are in this file.
void set_file(std::vector<Problem>& problems, size_t first, const std::string& file);

/// `file:line:column: where: message`, without the parts that are not known.
std::string describe(const std::string& file, const Problem& problem);

/// A problem of a checked graph's node; `about` names the port, the parameter or the part of one ("weights.height",
/// "maps.0") that is to blame, or is empty.
Problem problem_of(const GraphNode& node, const std::string& about, const std::string& message);

/// Of many problems only the first ones are shown, and only these are worth a search for what may be meant instead.
inline constexpr size_t most_problems_shown = 100;
/// "and 99,900 more problems" of so many; empty if all are shown.
std::string problems_not_shown(size_t all, const char* what = "problem");

/// All problems of one document, in the order of their places; what() has one line for each that is shown.
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
