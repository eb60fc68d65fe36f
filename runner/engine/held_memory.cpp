#include "runner/engine/held_memory.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/exemplar/uv_map.h"
#include "core/image/image.h"
#include "core/material/material.h"
#include "core/node/report.h"

namespace terrazzo {

namespace {

/// The memory blocks of a value, and whether it reads from others when pulled.
class Parts {
 public:
  explicit Parts(const Value& value) {
    std::visit([&](const auto& v) { add(*v); }, value);
  }
  const std::vector<std::pair<const void*, uint64_t>>& all() const { return all_; }
  bool lazy() const { return lazy_; }

 private:
  void add(const Image& image) {
    // Images that differ only in their description share their pixels.
    if (const uint64_t bytes = image.source()->held_bytes())
      all_.emplace_back(image.source().get(), bytes);
    else
      lazy_ = true;
  }
  void add(const Material& material) {
    for (const Map& m : material.maps()) add(*m.image);
  }
  void add(const Features& features) {
    for (const FeatureImage& f : features.images()) add(*f.image);
    if (features.mask()) add(*features.mask());
  }
  void add(const Appearance& appearance) {
    uint64_t bytes = 0;
    for (const AppearanceLevel& l : appearance.levels())
      bytes += l.vectors.size() * sizeof(AppearanceVector) + l.usable.size() +
               (l.mean.size() + l.basis.size()) * sizeof(float);
    all_.emplace_back(&appearance, bytes);
  }
  void add(const Index& index) {
    uint64_t bytes = 0;
    for (const SimilarSets& s : index.levels()) bytes += s.positions.size() * sizeof(uint32_t);
    all_.emplace_back(&index, bytes);
    add(*index.appearance());
  }
  void add(const UvMap& uv) { all_.emplace_back(&uv, uv.pixels().size() * sizeof(ExemplarPixel)); }
  void add(const Report& report) {
    for (const Report::Picture& p : report.pictures()) add(*p.image);
  }

  std::vector<std::pair<const void*, uint64_t>> all_;
  bool lazy_ = false;
};

}  // namespace

int HeldMemory::new_record() {
  if (free_records_.empty()) {
    records_.emplace_back();
    return static_cast<int>(records_.size()) - 1;
  }
  const int record = free_records_.back();
  free_records_.pop_back();
  return record;
}

std::pair<int, bool> HeldMemory::add(int stage, const std::map<std::string, Value>& values) {
  release(stage);
  const int id = current_[stage] = new_record();
  Record& record = records_[id];
  record.holders = 1;
  bool lazy = false;
  for (const auto& [port, value] : values) {
    const Parts parts(value);
    lazy = lazy || parts.lazy();
    for (const auto& [where, bytes] : parts.all()) {
      Part& part = parts_[where];
      part.holders++;
      bytes_ += bytes - std::exchange(part.bytes, bytes);
      record.parts.push_back(where);
    }
  }
  return {id, lazy};
}

void HeldMemory::hold_loaded(int stage, const std::map<std::string, Value>& values) {
  add(stage, values);
}

void HeldMemory::hold_computed(int stage, const std::map<std::string, Value>& values, const std::vector<int>& inputs) {
  const auto [id, lazy] = add(stage, values);
  if (!lazy) return;
  for (const int input : inputs)
    if (current_[input] != none) {
      records_[id].inputs.push_back(current_[input]);
      records_[current_[input]].holders++;
    }
}

uint64_t HeldMemory::bytes_freed_by(int stage) const {
  if (current_[stage] == none || records_[current_[stage]].holders > 1) return 0;
  const std::vector<const void*>& parts = records_[current_[stage]].parts;
  uint64_t freed = 0;
  for (const void* where : std::set(parts.begin(), parts.end())) {
    const Part& part = parts_.at(where);
    if (part.holders == std::count(parts.begin(), parts.end(), where)) freed += part.bytes;
  }
  return freed;
}

void HeldMemory::release(int stage) {
  if (current_[stage] != none) drop(std::exchange(current_[stage], none));
}

/// Removes one holder. Not recursive: chains of lazy images may span thousands of stages.
void HeldMemory::drop(int record) {
  std::vector<int> dropped = {record};
  while (!dropped.empty()) {
    const int id = dropped.back();
    dropped.pop_back();
    Record& r = records_[id];
    if (--r.holders > 0) continue;
    for (const void* where : r.parts) {
      const auto part = parts_.find(where);
      if (--part->second.holders > 0) continue;
      bytes_ -= part->second.bytes;
      parts_.erase(part);
    }
    dropped.insert(dropped.end(), r.inputs.begin(), r.inputs.end());
    r = {};
    free_records_.push_back(id);
  }
}

}  // namespace terrazzo
