#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/node/node.h"
#include "core/node/value.h"
#include "runner/editor/previews/picture_store.h"
#include "runner/editor/previews/wishes.h"

namespace terrazzo {

/// Sends an event to all tabs; of events of which only the last one counts, one that a tab has not got yet may be
/// replaced.
using PublishEvent =
    std::function<void(const std::string& event, const nlohmann::ordered_json& data, bool only_last_counts)>;

/// The pictures that are shown at the moment: makes them of values, and tells the tabs. Thread-safe.
class PictureBoard {
 public:
  PictureBoard(PictureStore& store, PublishEvent publish);

  /// Whether these outputs are shown as wished already. If so, tells the tabs that they still hold.
  bool confirm(const Wish& wish, const std::map<std::string, Digest>& outputs);
  /// Shows an output's value. Throws Cancelled, and Error if pixels cannot be computed.
  void show(const Wish& wish, const std::string& output, const Value& value, const std::atomic<bool>& cancelled);
  /// Shows what an output will roughly be. `full`: the size of the result. Nothing once it is cancelled.
  void show_coarse(const Wish& wish, const Port& output, const ImagePtr& image, Size full,
                   const std::atomic<bool>& cancelled);
  /// Forgets the pictures of all other nodes.
  void retain(const std::vector<Wish>& wishes);
  /// The data of the events "picture" that bring a new tab up to date.
  std::vector<std::string> current() const;

 private:
  struct Output {
    std::string identity;                       ///< of the value, and how it is shown
    std::map<std::string, std::string> events;  ///< by map
  };
  using Place = std::pair<NodeOfDocument, std::string>;
  void send(const Wish& wish, const std::string& output, const std::string& map, const nlohmann::ordered_json& event,
            const std::atomic<bool>& cancelled);

  PictureStore& store_;
  PublishEvent publish_;
  std::mutex sending_;  // what is sent after a cancellation comes after what was cancelled
  mutable std::mutex mutex_;
  std::map<Place, Output> shown_;
};

}  // namespace terrazzo
