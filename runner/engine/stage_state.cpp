#include "runner/engine/stage_state.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace terrazzo {

namespace {

template <typename State, typename Event, size_t N>
std::optional<State> next(const std::array<Transition<State, Event>, N>& table, State from, Event event) {
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const Transition<State, Event>& t) { return t.from == from && t.event == event; });
  if (row == table.end()) return std::nullopt;
  return row->to;
}

[[noreturn]] void refuse(const Stage& stage, std::string_view name, std::string_view value, std::string_view event) {
  throw std::logic_error(
      fmt::format("stage \"{}\" (name {}, values {}) cannot take the event {}", stage.node->name, name, value, event));
}

}  // namespace

std::string_view name_of(NameState state) {
  constexpr std::array<std::string_view, 4> names = {"unknown", "looking_up", "nameless", "named"};
  return names[static_cast<size_t>(state)];
}

std::string_view name_of(NameEvent event) {
  constexpr std::array<std::string_view, 4> names = {"inputs_named", "found", "not_found", "computed"};
  return names[static_cast<size_t>(event)];
}

std::string_view name_of(ValueState state) {
  constexpr std::array<std::string_view, 7> names = {"open",      "resting", "loading", "awaiting",
                                                     "computing", "held",    "lost"};
  return names[static_cast<size_t>(state)];
}

std::string_view name_of(ValueEvent event) {
  constexpr std::array<std::string_view, 10> names = {"rest",       "load", "compute",  "inputs_held", "read",
                                                      "unreadable", "busy", "computed", "let_go",      "give_up"};
  return names[static_cast<size_t>(event)];
}

StageStates::StageStates(const Plan& plan) : plan_(plan), entries_(plan.stages.size()) {
  for (size_t i = 0; i < entries_.size(); i++) {
    const Stage& s = plan.stages[i];
    entries_[i].unnamed_sources = entries_[i].unheld_sources = static_cast<int>(s.sources.size());
    entries_[i].claims = static_cast<int>(s.readers.size()) + (s.kept ? 1 : 0);
  }
}

void StageStates::advance(int stage, NameEvent event) {
  Entry& e = entries_[stage];
  const std::optional<NameState> to = next(name_transitions, e.name, event);
  if (!to || !go_together(*to, e.value)) refuse(plan_.stages[stage], name_of(e.name), name_of(e.value), name_of(event));
  e.name = *to;
  if (*to != NameState::named) return;
  for (const int reader : plan_.stages[stage].readers) entries_[reader].unnamed_sources--;
}

void StageStates::advance(int stage, ValueEvent event) {
  const Entry& e = entries_[stage];
  const std::optional<ValueState> to = next(value_transitions, e.value, event);
  if (!to || !go_together(e.name, *to)) refuse(plan_.stages[stage], name_of(e.name), name_of(e.value), name_of(event));
  enter(stage, *to);
}

bool StageStates::gathers(int stage) const {
  const std::vector<int>& sources = plan_.stages[stage].sources;
  return value(stage) == ValueState::awaiting && std::all_of(sources.begin(), sources.end(), [&](int source) {
           return value(source) == ValueState::held || value(source) == ValueState::loading;
         });
}

void StageStates::enter(int stage, ValueState to) {
  const Stage& s = plan_.stages[stage];
  const ValueState from = std::exchange(entries_[stage].value, to);
  if (const int claims = int{claims_sources(to)} - int{claims_sources(from)}; claims != 0)
    for (const int source : s.sources) entries_[source].claims += claims;
  if (const int held = int{to == ValueState::held} - int{from == ValueState::held}; held != 0)
    for (const int reader : s.readers) entries_[reader].unheld_sources -= held;
}

}  // namespace terrazzo
