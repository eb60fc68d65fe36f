#include "runner/engine/stage_state.h"

#include <algorithm>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/runner/engine/dice.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr int name_states = 4, name_events = 4, value_states = 7, value_events = 10;

/// Brings a stage without sources from the beginning into a state.
void lead_to(StageStates& states, NameState state) {
  using E = NameEvent;
  if (state == NameState::unknown) return;
  states.advance(0, E::inputs_named);
  if (state == NameState::looking_up) return;
  states.advance(0, state == NameState::named ? E::found : E::not_found);
}

void lead_to(StageStates& states, ValueState state) {
  using E = ValueEvent;
  const std::vector<std::vector<E>> ways = {{},
                                            {E::rest},
                                            {E::rest, E::load},
                                            {E::compute},
                                            {E::compute, E::inputs_held},
                                            {E::rest, E::load, E::read},
                                            {E::give_up}};
  for (const E event : ways[static_cast<size_t>(state)]) states.advance(0, event);
}

/// What a stage that is in both states says to an event: its new state, or "no".
template <typename Event>
std::string answer(NameState name, ValueState value, Event event) {
  FakeTypes t;
  Graph g;
  add(g, "a", t.number, {{"value", 1.0}});
  const Plan plan = make_plan(g, nullptr);
  StageStates states(plan);
  lead_to(states, name);
  lead_to(states, value);
  REQUIRE(states.name(0) == name);
  REQUIRE(states.value(0) == value);
  try {
    states.advance(0, event);
  } catch (const std::logic_error& e) {
    CHECK(std::string(e.what()) == fmt::format("stage \"a\" (name {}, values {}) cannot take the event {}",
                                               name_of(name), name_of(value), name_of(event)));
    CHECK(states.name(0) == name);
    CHECK(states.value(0) == value);
    return "no";
  }
  if constexpr (std::is_same_v<Event, NameEvent>)
    return std::string(name_of(states.name(0)));
  else
    return std::string(name_of(states.value(0)));
}

}  // namespace

TEST_CASE("a stage's names go the ways of the table and no other") {
  // One line per state, one column per event: inputs_named, found, not_found, computed.
  const std::array<std::array<std::string, name_events>, name_states> expected = {{
      {"looking_up", "no", "no", "no"},   // unknown
      {"no", "named", "nameless", "no"},  // looking_up
      {"no", "no", "no", "named"},        // nameless
      {"no", "no", "no", "no"},           // named
  }};
  for (int s = 0; s < name_states; s++)
    for (int e = 0; e < name_events; e++) CHECK(answer(NameState(s), ValueState::open, NameEvent(e)) == expected[s][e]);
}

TEST_CASE("the values of a stage that is named go the ways of the table and no other") {
  // One line per state, one column per event: rest, load, compute, inputs_held, read, unreadable, busy, computed,
  // let_go, give_up.
  const std::array<std::array<std::string, value_events>, value_states> expected = {{
      {"resting", "no", "awaiting", "no", "no", "no", "no", "no", "no", "lost"},  // open
      {"no", "loading", "awaiting", "no", "no", "no", "no", "no", "no", "no"},    // resting
      {"no", "no", "no", "no", "held", "awaiting", "no", "no", "no", "lost"},     // loading
      {"no", "no", "no", "computing", "no", "no", "no", "no", "no", "lost"},      // awaiting
      {"no", "no", "no", "no", "no", "no", "computing", "held", "no", "lost"},    // computing
      {"no", "no", "no", "no", "no", "no", "no", "no", "resting", "no"},          // held
      {"no", "no", "no", "no", "no", "no", "no", "no", "no", "no"},               // lost
  }};
  for (int s = 0; s < value_states; s++)
    for (int e = 0; e < value_events; e++)
      CHECK(answer(NameState::named, ValueState(s), ValueEvent(e)) == expected[s][e]);
}

TEST_CASE("nothing is made before the key is known, and nothing is in memory without a name") {
  for (const NameState early : {NameState::unknown, NameState::looking_up})
    for (int e = 0; e < value_events; e++)
      CHECK(answer(early, ValueState::open, ValueEvent(e)) == (ValueEvent(e) == ValueEvent::give_up ? "lost" : "no"));
  CHECK(answer(NameState::nameless, ValueState::open, ValueEvent::compute) == "awaiting");
  CHECK(answer(NameState::nameless, ValueState::open, ValueEvent::rest) == "no");
  CHECK(answer(NameState::nameless, ValueState::awaiting, ValueEvent::inputs_held) == "computing");
  CHECK(answer(NameState::nameless, ValueState::computing, ValueEvent::busy) == "computing");
  CHECK(answer(NameState::nameless, ValueState::computing, ValueEvent::computed) == "no");
  CHECK(answer(NameState::nameless, ValueState::computing, NameEvent::computed) == "named");
}

namespace {

Graph tangle(const FakeTypes& t, Dice& dice, int count) {
  Graph g;
  for (int i = 0; i < count; i++) {
    std::vector<std::string> in;
    for (int k = i == 0 ? 0 : dice.roll(4); k > 0; k--) in.push_back(fmt::format("n{}", dice.roll(i)));
    add(g, fmt::format("n{}", i), t.sum, {}, in);
  }
  return g;
}

}  // namespace

TEST_CASE("what follows for the neighbours is what counting them gives, after any moves") {
  FakeTypes t;
  int moves = 0;
  for (uint64_t seed = 1; seed <= 5; seed++) {
    Dice dice(seed);
    const Graph g = tangle(t, dice, 30);
    const Plan plan = make_plan(g, nullptr, {.only = {"n29", "n28"}, .keep = {"n28"}});
    StageStates states(plan);
    for (int i = 0; i < 3000; i++) {
      const int stage = dice.roll(30);
      if (!plan.stages[stage].needed) continue;
      try {
        if (dice.roll(3) == 0)
          states.advance(stage, NameEvent(dice.roll(name_events)));
        else
          states.advance(stage,
                         ValueEvent(dice.roll(dice.roll(10) == 0 ? value_events : value_events - 1)));  // few lost
        moves++;
      } catch (const std::logic_error&) {
        continue;
      }
      for (int k = 0; k < 30; k++) {
        const Stage& s = plan.stages[k];
        const auto named = [&](int source) { return states.name(source) == NameState::named; };
        const auto held = [&](int source) { return states.value(source) == ValueState::held; };
        const auto asks = [&](int reader) { return claims_sources(states.value(reader)); };
        if (!s.needed) continue;
        REQUIRE(states.inputs_named(k) == std::all_of(s.sources.begin(), s.sources.end(), named));
        REQUIRE(states.inputs_held(k) == std::all_of(s.sources.begin(), s.sources.end(), held));
        REQUIRE(states.claimed(k) == (s.kept || std::any_of(s.readers.begin(), s.readers.end(), asks)));
      }
    }
  }
  CHECK(moves > 500);
}
