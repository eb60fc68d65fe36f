#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "runner/engine/plan.h"

/// What becomes of a stage in a run: where its outputs' names stand, where their values stand, and the only moves there
/// are between these states.
///
/// Names flow forward: a stage whose inputs all have names is looked up. Values are made on demand, backward: a stage
/// that is to be computed asks its sources, and they load their values, compute them, or hold them already.
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
  not_found,  ///< nobody knows them
  computed,
};

/// The values of a stage's outputs.
enum class ValueState : uint8_t {
  open,       ///< not in memory; the stage may have to be computed
  resting,    ///< not in memory; nobody is going to ask, or the values can be loaded
  loading,    ///< on their way from the cache
  awaiting,   ///< to be computed as soon as all sources' values are in memory
  computing,  ///< a job for it waits or runs, here or in another process
  held,       ///< in memory
};
enum class ValueEvent : uint8_t {
  rest,         ///< it is certain that no reader needs it to be computed
  load,         ///< asked for, and the cache has them
  compute,      ///< asked for, and the cache has them not; or the stage has to run in any case
  inputs_held,  ///< the last of its sources' values is in memory
  read,         ///< out of the cache
  unreadable,   ///< the cache's entry is gone or damaged
  busy,         ///< another process is computing it; to be tried again
  computed,
  let_go,  ///< no reader is going to ask for them again
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

/// Every move there is. A stage whose job fails stays where it is: the run ends.
inline constexpr std::array name_transitions = {
    Transition{NameState::unknown, NameEvent::inputs_named, NameState::looking_up},
    Transition{NameState::looking_up, NameEvent::found, NameState::named},
    Transition{NameState::looking_up, NameEvent::not_found, NameState::nameless},
    Transition{NameState::nameless, NameEvent::computed, NameState::named},
};
inline constexpr std::array value_transitions = {
    Transition{ValueState::open, ValueEvent::rest, ValueState::resting},
    Transition{ValueState::open, ValueEvent::compute, ValueState::awaiting},
    Transition{ValueState::resting, ValueEvent::load, ValueState::loading},
    Transition{ValueState::resting, ValueEvent::compute, ValueState::awaiting},  // a reader's stored values are damaged
    Transition{ValueState::loading, ValueEvent::read, ValueState::held},
    Transition{ValueState::loading, ValueEvent::unreadable, ValueState::awaiting},
    Transition{ValueState::awaiting, ValueEvent::inputs_held, ValueState::computing},
    Transition{ValueState::computing, ValueEvent::busy, ValueState::computing},
    Transition{ValueState::computing, ValueEvent::computed, ValueState::held},
    Transition{ValueState::held, ValueEvent::let_go, ValueState::resting},
};

/// Whether a stage in this state may still ask for its sources' values, so that they must not be let go.
constexpr bool claims_sources(ValueState state) {
  return state == ValueState::open || state == ValueState::awaiting || state == ValueState::computing;
}

/// Whether a stage can be in both states at once: a key is looked up before anything is made, and whatever is in
/// memory, or might be loaded, has a name.
constexpr bool go_together(NameState name, ValueState value) {
  switch (name) {
    case NameState::unknown:
    case NameState::looking_up:
      return value == ValueState::open;
    case NameState::nameless:
      return claims_sources(value);
    case NameState::named:
      return true;
  }
  return false;
}

/// The states of all stages of a plan, and what follows from them for the neighbours. Not thread-safe.
class StageStates {
 public:
  /// Every stage's name is unknown and its values are open. The plan must outlive it.
  explicit StageStates(const Plan& plan);

  NameState name(int stage) const { return entries_[stage].name; }
  ValueState value(int stage) const { return entries_[stage].value; }

  /// The only ways to change a state. Throw std::logic_error that names the stage, its state and the event if the
  /// tables do not allow it, and leave everything as it was then.
  void advance(int stage, NameEvent event);
  void advance(int stage, ValueEvent event);

  /// Every source is named.
  bool inputs_named(int stage) const { return entries_[stage].unnamed_sources == 0; }
  /// Every source's values are in memory.
  bool inputs_held(int stage) const { return entries_[stage].unheld_sources == 0; }
  /// A reader may still ask for its values, or the caller wants to keep them.
  bool claimed(int stage) const { return entries_[stage].claims > 0; }

 private:
  /// The numbers follow from the neighbours' states; kept so that nobody has to count in wide graphs.
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
