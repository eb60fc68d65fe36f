#include "core/synthesis/state/span_order.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/geometry.h"

namespace terrazzo {

namespace {

std::vector<double> lengths_of(const std::vector<ExemplarSpan>& spans) {
  std::vector<double> out;
  for (const ExemplarSpan& s : spans) out.push_back(s.length());
  return out;
}

}  // namespace

SpanOrder::SpanOrder(const std::vector<ExemplarSpan>& spans, const SpanLine& line, uint64_t bits)
    : spans_(spans), line_(line), random_(lengths_of(spans), bits) {}

void SpanOrder::keep(int at, int shown, const std::function<bool(size_t)>& may_be) {
  kept_at_.resize(size_t(line_.result), 0);
  kept_at_[size_t(at)]++;
  for (size_t k = 0; k < spans_.size(); k++)
    for (const int u : {shown, shown + line_.exemplar}) {
      if (u < spans_[k].from || u >= spans_[k].to || !may_be(k)) continue;
      const int begin = int(std::floor(at - (u - spans_[k].from) + 0.5));
      votes_[{int(k), line_.closed ? wrap(begin, line_.result) : begin}]++;
    }
}

std::vector<ShownSpan> SpanOrder::order() {
  std::vector<ShownSpan> out = kept();
  if (!out.empty()) {
    fill_around(out);
  } else if (line_.closed) {
    const double begin = std::floor(random_.draw() * line_.result);
    out = filled(begin, line_.result, {});
    if (out.empty()) out = in_sequence(begin, {0}, line_.result / spans_.front().length());
  } else {
    const double cut = random_.draw() * spans_.front().length();
    out = in_sequence(-cut, random_.endless(line_.result + cut));
  }
  for (ShownSpan& s : out) {
    const double back = line_.closed && s.begin >= line_.result ? line_.result : 0;
    s.begin -= back;
    s.end -= back;
    s.cut -= back;
  }
  std::ranges::sort(out, {}, &ShownSpan::begin);
  return out;
}

std::vector<ShownSpan> SpanOrder::in_sequence(double begin, const std::vector<int>& numbers, double stretched) const {
  std::vector<ShownSpan> out;
  for (const int k : numbers) {
    const ExemplarSpan& span = spans_[size_t(k)];
    const double end = begin + span.length() * stretched;
    out.push_back({begin, end, k, span, (begin + end) / 2});
    begin = end;
  }
  return out;
}

std::vector<ShownSpan> SpanOrder::filled(double begin, double length, const SequenceEnds& ends) {
  const std::vector<int> numbers = random_.filling(length, ends);
  return numbers.empty() ? std::vector<ShownSpan>() : in_sequence(begin, numbers, length / random_.length_of(numbers));
}

void SpanOrder::fill_around(std::vector<ShownSpan>& spans) {
  const auto add = [&](const std::vector<ShownSpan>& more) { spans.insert(spans.end(), more.begin(), more.end()); };
  const size_t kept = spans.size();
  const ShownSpan first = spans.front(), last = spans.back();
  for (size_t i = 0; i + 1 < kept; i++)
    add(filled(spans[i].end, spans[i + 1].begin - spans[i].end, {spans[i].number, spans[i + 1].number}));
  if (line_.closed) {
    add(filled(last.end, first.begin + line_.result - last.end, {last.number, first.number}));
    return;
  }
  std::vector<int> before = random_.endless(first.begin, first.number);
  std::ranges::reverse(before);
  add(in_sequence(first.begin - random_.length_of(before), before));
  add(in_sequence(last.end, random_.endless(line_.result - last.end, last.number)));
}

std::vector<ShownSpan> SpanOrder::kept() const {
  // What lies a pixel or two beside, as where spans are stretched, counts as well.
  constexpr int beside = 2;
  std::vector<std::tuple<int64_t, int, int>> most;
  for (const auto& [place, count] : votes_) {
    int64_t sum = 0;
    for (auto v = votes_.lower_bound({place.first, place.second - beside});
         v != votes_.end() && v->first <= std::pair(place.first, place.second + beside); v++)
      sum += v->second;
    most.emplace_back(-sum, place.first, place.second);
  }
  std::ranges::sort(most);
  std::vector<ShownSpan> out;
  for (const auto& [count, k, begin] : most) {
    const ShownSpan s = in_sequence(begin, {k}).front();
    int64_t in_place = 0;
    for (int at = begin; at < int(s.end); at++)
      if (line_.closed || (at >= 0 && at < line_.result)) in_place += kept_at_[size_t(wrap(at, line_.result))];
    if (-2 * count > in_place && std::ranges::none_of(out, [&](const ShownSpan& o) { return overlap(o, s); }))
      out.push_back(s);
  }
  std::ranges::sort(out, {}, &ShownSpan::begin);
  return out;
}

/// By more than a quarter of the shorter one.
bool SpanOrder::overlap(const ShownSpan& a, const ShownSpan& b) const {
  const auto common = [&](double by) { return std::min(a.end, b.end + by) - std::max(a.begin, b.begin + by); };
  const double around = line_.closed ? std::max(common(line_.result), common(-line_.result)) : 0;
  return std::max(common(0), around) > std::min(a.end - a.begin, b.end - b.begin) / 4;
}

}  // namespace terrazzo
