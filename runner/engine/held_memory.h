#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/node/value.h"

namespace terrazzo {

/// Estimates the memory of values that wait for readers: pixels, vectors and positions. Shared parts (an index and its
/// appearance, a material and its maps) count once. A lazy image keeps the inputs of its stage alive, so they count as
/// long as it is held. Not thread-safe.
class HeldMemory {
 public:
  explicit HeldMemory(size_t stages) : current_(stages, none) {}

  /// Adds the values of a stage, computed from those that the stages `inputs` hold now.
  void hold_computed(int stage, const std::map<std::string, Value>& values, const std::vector<int>& inputs);
  /// The same for values from the cache, whose images are read on demand and take no memory.
  void hold_loaded(int stage, const std::map<std::string, Value>& values);
  /// Removes the values of a stage, if it has any.
  void release(int stage);
  uint64_t bytes() const { return bytes_; }
  /// The bytes that releasing the stage's values would free now.
  uint64_t bytes_freed_by(int stage) const;

 private:
  static constexpr int none = -1;

  /// The values of one stage, held by the stage or by lazy values derived from them.
  struct Record {
    std::vector<const void*> parts;
    std::vector<int> inputs;  ///< records
    int holders = 0;
  };
  struct Part {
    uint64_t bytes = 0;
    int holders = 0;
  };

  int new_record();
  /// Returns the stage's new record and whether any of the values is lazy.
  std::pair<int, bool> add(int stage, const std::map<std::string, Value>& values);
  void drop(int record);

  std::vector<int> current_;  ///< the record of each stage that holds values
  std::vector<Record> records_;
  std::vector<int> free_records_;
  std::unordered_map<const void*, Part> parts_;
  uint64_t bytes_ = 0;
};

}  // namespace terrazzo
