#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include <nlohmann/json_fwd.hpp>

/// What a document said lately: clients that change the same thing at the same time do not know of each other yet.
namespace terrazzo {

/// The texts of the last revisions. Not thread-safe.
class RecentTexts {
 public:
  void add(int64_t revision, const std::string& text);

  /// The JSON pointer of the first value among these edits that has changed between the revision and the text of now;
  /// empty if there is none, or the revision is not known any more. Looks at set, unset, value, parameter and preset.
  std::string changed_since(int64_t revision, const std::string& now, const nlohmann::ordered_json& edits) const;

 private:
  std::deque<std::pair<int64_t, std::string>> texts_;  ///< each with the revision that it came with
  size_t bytes_ = 0;
};

}  // namespace terrazzo
