#include "core/image/pull_plan.h"

#include <algorithm>
#include <unordered_map>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct PullPlanTuning {
  double most_area_added = 1.25;
  int area_of_a_call = 4096;
  int most_parts = 8;
};
const Tunable<PullPlanTuning> pull_plan_tuning(
    "pull_plan",
    {
        {&PullPlanTuning::most_area_added, "most_area_added", "factor",
         "up to which parts are put together. Higher: fewer calls; lower: fewer pixels that nobody asked for",
         "not measured: taken over from the code before constants were listed"},
        {&PullPlanTuning::area_of_a_call, "area_of_a_call", "pixels",
         "that a call costs as much as. Higher: fewer calls; lower: fewer pixels that nobody asked for",
         "not measured: taken over from the code before constants were listed"},
        {&PullPlanTuning::most_parts, "most_parts", "parts of an image",
         "higher: parts that lie far from one another stay apart; lower: fewer calls",
         "not measured: bounds the time of putting them together"},
    });

double cost_of_union(const Rect& a, const Rect& b) {
  return double(united(a, b).area()) - pull_plan_tuning->most_area_added * double(a.area() + b.area()) -
         double(pull_plan_tuning->area_of_a_call);
}

/// Adds a part to the needed parts of an image.
void add_part(std::vector<Rect>& parts, Rect part) {
  if (part.empty()) return;
  while (!parts.empty()) {
    const auto best = std::min_element(parts.begin(), parts.end(), [&](const Rect& a, const Rect& b) {
      return cost_of_union(a, part) < cost_of_union(b, part);
    });
    if (*best == part) return;
    if (cost_of_union(*best, part) > 0 && parts.size() < size_t(pull_plan_tuning->most_parts)) break;
    part = united(*best, part);
    parts.erase(best);
  }
  parts.push_back(part);
}

int64_t area_of(const std::vector<Rect>& parts) {
  int64_t area = 0;
  for (const Rect& part : parts) area += part.area();
  return area;
}

std::vector<Rect> parts_read(const Operation& operation, size_t source, const Rect& region) {
  return operation.reads ? operation.reads(source, region) : std::vector<Rect>{region};
}

}  // namespace

PullPlan::PullPlan(const PulledImage& image, Until until) {
  order(image, until);
  for (const Step& step : steps_)
    for (const int source : step.sources)
      if (source >= 0) steps_[source].readers++;
}

/// Depth first with an explicit stack: chains may have thousands of images.
void PullPlan::order(const PulledImage& image, Until until) {
  struct Open {
    Step step;
    size_t next = 0;
  };
  std::unordered_map<const PulledImage*, int> places;
  std::vector<Open> open;
  const auto enter = [&](std::shared_ptr<const PulledImage> entered, std::shared_ptr<const Operation> operation) {
    places.emplace(entered.get(), -1);
    open.push_back({Step{std::move(entered), std::move(operation), {}}});
  };
  // The caller holds the image.
  enter({std::shared_ptr<const PulledImage>(), &image}, image.operation());
  if (!open.back().step.operation) return;
  while (!open.empty()) {
    Open& top = open.back();
    if (top.next == top.step.operation->sources.size()) {
      places[top.step.image.get()] = static_cast<int>(steps_.size());
      steps_.push_back(std::move(top.step));
      open.pop_back();
      continue;
    }
    auto source = std::dynamic_pointer_cast<const PulledImage>(top.step.operation->sources[top.next]->source());
    const auto known = places.find(source.get());
    if (known != places.end()) {
      top.step.sources.push_back(known->second);
      top.next++;
      continue;
    }
    const bool ends = !source || (until == Until::to_be_kept && source->to_be_kept());
    std::shared_ptr<const Operation> operation = ends ? nullptr : source->operation();
    if (operation) {
      enter(std::move(source), std::move(operation));  // comes back to this source when it has a step
    } else {
      top.step.sources.push_back(-1);
      top.next++;
    }
  }
}

bool PullPlan::passes_by_kept() const {
  return std::any_of(steps_.begin(), steps_.end(), [](const Step& s) { return s.image->to_be_kept(); });
}

void PullPlan::keep_pixels() {
  for (Step& step : steps_) {
    if (step.image->to_be_kept()) step.image->keep();
    step = Step();
  }
  steps_.clear();
}

/// Determines the parts of each image that a region of the last one needs.
void PullPlan::demand(const Rect& region) {
  for (Step& step : steps_) {
    step.parts.clear();
    step.open_readers = step.readers;
  }
  steps_.back().parts = {region};
  for (size_t i = steps_.size(); i-- > 0;) {
    const Step& step = steps_[i];
    for (size_t s = 0; s < step.sources.size(); s++)
      if (step.sources[s] >= 0)
        for (const Rect& part : step.parts)
          for (const Rect& read : parts_read(*step.operation, s, part)) add_part(steps_[step.sources[s]].parts, read);
  }
}

void PullPlan::compute(Step& step, float* out) {
  std::vector<PixelView> sources;
  sources.reserve(step.sources.size());
  for (size_t s = 0; s < step.sources.size(); s++) {
    const Image& image = *step.operation->sources[s];
    if (step.sources[s] < 0)
      sources.emplace_back(image);
    else
      sources.emplace_back(image, steps_[step.sources[s]].blocks);
  }
  for (const Rect& part : step.parts) {
    if (out) return step.operation->compute(sources, part, out);
    PixelBlock block{part, std::unique_ptr<float[]>(new float[size_t(part.area()) * step.image->channels()])};
    step.operation->compute(sources, part, block.pixels.get());
    step.blocks.push_back(std::move(block));
  }
}

void PullPlan::let_go(const Step& step) {
  for (const int source : step.sources)
    if (source >= 0 && --steps_[source].open_readers == 0) steps_[source].blocks.clear();
}

void PullPlan::pull(const Rect& region, float* out) {
  demand(region);
  for (Step& step : steps_) {
    CurrentTask::task().check();
    compute(step, &step == &steps_.back() ? out : nullptr);
    let_go(step);
  }
}

/// Values that a step reads from images that are neither computed nor in memory.
int64_t PullPlan::values_read(const Step& step) {
  int64_t values = 0;
  for (size_t i = 0; i < step.sources.size(); i++) {
    const Image& source = *step.operation->sources[i];
    if (step.sources[i] >= 0 || source.in_memory()) continue;
    for (const Rect& part : step.parts) values += area_of(parts_read(*step.operation, i, part)) * source.channels();
  }
  return values;
}

int64_t PullPlan::most_values(const Rect& region) {
  demand(region);
  int64_t most = 0;
  for (const Step& step : steps_) {
    most = std::max(most, area_of(step.parts) * step.image->channels());
    most = std::max(most, values_read(step) / read_for_one);
  }
  return most;
}

double PullPlan::work_by_strips(int rows) {
  const Size size = steps_.back().image->size();
  if (size.height <= rows) return 1;
  demand({0, (size.height - rows) / 2, size.width, rows});
  const double share = double(rows) / size.height;
  double once = 0, by_strips = 0;
  for (const Step& step : steps_) {
    const double work = step.operation->work * double(step.image->size().area()) * step.image->channels();
    const double needed = double(area_of(step.parts)) / double(step.image->size().area()) / share;
    once += work * std::min(1.0, needed);
    by_strips += work * needed;
  }
  return by_strips / once;
}

}  // namespace terrazzo
