#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graphs/text/problem.h"

namespace terrazzo {

/// Collects the problems of one part of a document, with their places.
class Diagnostics {
 public:
  Diagnostics(std::vector<Problem>& all, std::string where, std::string parameter = {})
      : Diagnostics(
            all, Problem{.place = {}, .where = std::move(where), .message = "", .parameter = std::move(parameter)}) {}
  /// `about`: what all problems have in common; its message is added to theirs.
  Diagnostics(std::vector<Problem>& all, Problem about) : all_(all), about_(std::move(about)) {}

  /// For values from outside of the document: all problems have the place of `about`.
  Diagnostics& at_one_place() {
    has_places_ = false;
    return *this;
  }
  /// A suffix for every message that tells where the value comes from.
  void set_origin(std::string origin) { origin_ = std::move(origin); }

  void add(Place place, const std::string& message) {
    Problem& problem = all_.emplace_back(about_);
    if (has_places_) problem.place = place;
    problem.message = message + origin_ + about_.message;
  }

 private:
  std::vector<Problem>& all_;
  Problem about_;
  std::string origin_;
  bool has_places_ = true;
};

}  // namespace terrazzo
