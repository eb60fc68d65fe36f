#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/node/value.h"

namespace terrazzo {

/// How much memory the values that wait for their readers take, roughly: pixels, vectors and positions. What several
/// values share (an index and its appearance, a material and one of its maps) counts once. A lazy image is read from
/// the inputs of the stage that made it, so these count for as long as it is held, whether or not their own stages
/// still hold them. Not thread-safe.
class HeldMemory {
 public:
  explicit HeldMemory(size_t stages) : current_(stages, none) {}

  /// The values of a stage are in memory from now on, computed from those that these stages hold just now.
  void hold_computed(int stage, const std::map<std::string, Value>& values, const std::vector<int>& inputs);
  /// The same for values from the cache: images are read from there when they are pulled, and take no memory.
  void hold_loaded(int stage, const std::map<std::string, Value>& values);
  /// The stage has let them go; nothing happens if it had none.
  void release(int stage);
  uint64_t bytes() const { return bytes_; }

 private:
  static constexpr int none = -1;

  /// Values of one stage, held by it or by what is read from them.
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
  std::pair<int, bool> add(int stage, const std::map<std::string, Value>& values, uint64_t half_bytes);
  void drop(int record);

  std::vector<int> current_;  ///< the record of each stage that holds values
  std::vector<Record> records_;
  std::vector<int> free_records_;
  std::unordered_map<const void*, Part> parts_;
  uint64_t bytes_ = 0;
};

}  // namespace terrazzo
