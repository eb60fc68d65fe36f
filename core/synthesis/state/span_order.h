#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/exemplar/lattice.h"
#include "core/synthesis/state/random_order.h"

namespace terrazzo {

/// The line along which spans of an exemplar are shown, in pixels of the finest level.
struct SpanLine {
  int exemplar;  ///< its length; spans may go on around its border
  int result;    ///< the result's
  bool closed;   ///< the result wraps
};

/// In which order a result shows spans of an exemplar along one axis: at random, or as what is kept has them. Used by
/// one thread.
class SpanOrder {
 public:
  /// `spans`: at least one, in ascending order.
  SpanOrder(const std::vector<ExemplarSpan>& spans, const SpanLine& line, uint64_t bits);

  /// A pixel that is kept at `at`, along the axis, shows the exemplar's `shown`, if it lies in one of those spans of
  /// which `may_be` tells by their numbers that it can be.
  void keep(
      int at, int shown, const std::function<bool(size_t)>& may_be = [](size_t) { return true; });

  /// Spans in ascending order that cover all of the result, around its border if it wraps: those that most of what is
  /// kept in their place shows, and others between and around them, each about as often as the others. Where the result
  /// wraps, or what is kept leaves a gap, those are chosen whose lengths make it up, and stretched by what is missing.
  /// Another one each time.
  std::vector<ShownSpan> order();

 private:
  using Votes = std::map<std::pair<int, int>, int64_t>;  // for spans that begin somewhere, by number and place

  std::vector<ShownSpan> in_sequence(double begin, const std::vector<int>& numbers, double stretched = 1) const;
  std::vector<ShownSpan> filled(double begin, double length, const SequenceEnds& ends);
  void fill_around(std::vector<ShownSpan>& spans);
  std::vector<ShownSpan> kept() const;
  bool overlap(const ShownSpan& a, const ShownSpan& b) const;

  const std::vector<ExemplarSpan>& spans_;
  SpanLine line_;
  RandomOrder random_;
  Votes votes_;
  std::vector<int64_t> kept_at_;  // of each pixel along the result, how many are kept; empty: none
};

}  // namespace terrazzo
