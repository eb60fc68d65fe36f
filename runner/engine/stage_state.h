#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "runner/plan/plan.h"

/// The states of a stage in a run, one for its outputs' names and one for their values, with the allowed transitions.
///
/// Names flow forward: a stage whose inputs all have names is looked up. Values are demanded backward: a stage that
/// must be computed asks its sources, which load their values, compute them, or already hold them.
namespace terrazzo {

/// The names (digests) of a stage's outputs.
enum class NameState : uint8_t {
  unknown,     ///< an input has no name yet
  looking_up,  ///< all inputs have names; the stage's key is being looked up
  nameless,    ///< the key is known; the outputs get their names when the stage is computed
  named,       ///< the readers may be looked up
};
enum class NameEvent : uint8_t {
  inputs_named,
  found,      ///< the cache knows the names, or the stage is lazy and they follow from its key
  not_found,  ///< the cache does not know them
  computed,
};

/// The values of a stage's outputs.
enum class ValueState : uint8_t {
  open,       ///< not in memory; the stage may have to be computed
  resting,    ///< not in memory; not needed, or loadable
  loading,    ///< being loaded from the cache
  awaiting,   ///< will be computed as soon as all sources' values are in memory
  computing,  ///< its job is queued or runs, here or in another process
  held,       ///< in memory
  lost,       ///< unavailable in this run: the stage or one of its sources failed (with `keep_going`)
};
enum class ValueEvent : uint8_t {
  rest,         ///< no reader will need it to be computed
  load,         ///< needed, and in the cache
  compute,      ///< needed and not in the cache; or the stage must run anyway
  inputs_held,  ///< the last of its sources' values is in memory
  read,         ///< loaded from the cache
  unreadable,   ///< the cache entry is missing or damaged
  busy,         ///< another process is computing it; retry later
  computed,
  let_go,   ///< no reader will need them again, or they will be loaded again
  give_up,  ///< its job failed, or a source that it needs is lost
};

std::string_view name_of(NameState state);
std::string_view name_of(NameEvent event);
std::string_view name_of(ValueState state);
std::string_view name_of(ValueEvent event);

template <typename State, typename Event>
struct Transition {
  State from;
  Event event;
  State to;
};
using NameTransition = Transition<NameState, NameEvent>;
using ValueTransition = Transition<ValueState, ValueEvent>;

/// All allowed transitions. A stage whose job fails keeps its state if the run ends with the first failure.
inline constexpr std::array name_transitions = {
    NameTransition{NameState::unknown, NameEvent::inputs_named, NameState::looking_up},
    NameTransition{NameState::looking_up, NameEvent::found, NameState::named},
    NameTransition{NameState::looking_up, NameEvent::not_found, NameState::nameless},
    NameTransition{NameState::nameless, NameEvent::computed, NameState::named},
};
inline constexpr std::array value_transitions = {
    ValueTransition{ValueState::open, ValueEvent::rest, ValueState::resting},
    ValueTransition{ValueState::open, ValueEvent::compute, ValueState::awaiting},
    ValueTransition{ValueState::resting, ValueEvent::load, ValueState::loading},
    ValueTransition{ValueState::resting, ValueEvent::compute,
                    ValueState::awaiting},  // a reader's stored values are damaged
    ValueTransition{ValueState::loading, ValueEvent::read, ValueState::held},
    ValueTransition{ValueState::loading, ValueEvent::unreadable, ValueState::awaiting},
    ValueTransition{ValueState::awaiting, ValueEvent::inputs_held, ValueState::computing},
    ValueTransition{ValueState::computing, ValueEvent::busy, ValueState::computing},
    ValueTransition{ValueState::computing, ValueEvent::computed, ValueState::held},
    ValueTransition{ValueState::held, ValueEvent::let_go, ValueState::resting},
    ValueTransition{ValueState::open, ValueEvent::give_up, ValueState::lost},
    ValueTransition{ValueState::loading, ValueEvent::give_up, ValueState::lost},
    ValueTransition{ValueState::awaiting, ValueEvent::give_up, ValueState::lost},
    ValueTransition{ValueState::computing, ValueEvent::give_up, ValueState::lost},
};

/// Whether a stage in this state may still need its sources' values in memory.
constexpr bool claims_sources(ValueState state) {
  return state == ValueState::open || state == ValueState::awaiting || state == ValueState::computing;
}

/// Whether both states can occur together: a key is looked up before anything is computed, and values in memory or in
/// the cache have a name.
constexpr bool go_together(NameState name, ValueState value) {
  switch (name) {
    case NameState::unknown:
    case NameState::looking_up:
      return value == ValueState::open || value == ValueState::lost;
    case NameState::nameless:
      return claims_sources(value) || value == ValueState::lost;
    case NameState::named:
      return true;
  }
  return false;
}

/// The states of all stages of a plan. Not thread-safe.
class StageStates {
 public:
  /// Every stage's name is unknown and its values are open. The plan must outlive it.
  explicit StageStates(const Plan& plan);

  NameState name(int stage) const { return entries_[stage].name; }
  ValueState value(int stage) const { return entries_[stage].value; }

  /// Applies a transition. Throws std::logic_error, which names stage, state and event, and changes nothing, if the
  /// tables do not allow it.
  void advance(int stage, NameEvent event);
  void advance(int stage, ValueEvent event);

  /// Every source is named.
  bool inputs_named(int stage) const { return entries_[stage].unnamed_sources == 0; }
  /// Every source's values are in memory.
  bool inputs_held(int stage) const { return entries_[stage].unheld_sources == 0; }
  /// It waits for its sources' values, all of which are in memory or being loaded.
  bool gathers(int stage) const;
  /// A reader may still need its values, or the caller keeps them.
  bool claimed(int stage) const { return entries_[stage].claims > 0; }

 private:
  /// The counters are redundant: they avoid counting neighbours in wide graphs.
  struct Entry {
    NameState name = NameState::unknown;
    ValueState value = ValueState::open;
    int unnamed_sources = 0;
    int unheld_sources = 0;
    int claims = 0;
  };

  void enter(int stage, ValueState to);

  const Plan& plan_;
  std::vector<Entry> entries_;
};

}  // namespace terrazzo
