#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graphs/text/problem.h"

namespace terrazzo {

/// Collects the problems of one part of a document, with their places.
class Diagnostics {
 public:
  Diagnostics(std::vector<Problem>& all, std::string where) : all_(all), where_(std::move(where)) {}

  /// Drops places, since values from the command line have none.
  Diagnostics& from_command_line() {
    has_places_ = false;
    return *this;
  }
  /// A suffix for every message that tells where the value comes from.
  void set_origin(std::string origin) { origin_ = std::move(origin); }

  void add(Place place, const std::string& message) {
    all_.push_back({has_places_ ? place : Place{}, where_, message + origin_});
  }

 private:
  std::vector<Problem>& all_;
  std::string where_;
  std::string origin_;
  bool has_places_ = true;
};

}  // namespace terrazzo
