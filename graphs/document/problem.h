#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "graphs/document/graph.h"

namespace terrazzo {

/// Something wrong in a graph document or in an override.
struct Problem {
  Place place;          ///< 0:0 for overrides and whole files
  std::string where;    ///< `node "x", parameter "y"`; may be empty
  std::string message;  ///< what was expected, what was found, the nearest valid choice
};

/// `file:line:column: where: message`, without the parts that are not known.
std::string describe(const std::string& file, const Problem& problem);

/// All problems of one document, in the order of their places; what() has one line for each.
class GraphError : public Error {
 public:
  GraphError(const std::string& file, std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace terrazzo
