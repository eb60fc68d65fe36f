#include "graphs/text/part_matching.h"

#include <algorithm>
#include <map>
#include <utility>

namespace terrazzo {

namespace {

using LineAndColumn = std::pair<int, int>;

LineAndColumn key_of(Place place) {
  return {place.line, place.column};
}

/// Members match by name and place, else by name, else by place: then they have another name.
std::vector<size_t> matched_members(const TextPart& before, const JsonValue& after) {
  const std::vector<JsonMember>& old = before.json->members;
  std::map<LineAndColumn, size_t> by_place;
  std::map<std::string_view, size_t> by_name;
  for (size_t i = 0; i < old.size(); i++) {
    by_place.emplace(key_of(old[i].place), i);
    by_name.emplace(old[i].name, i);
  }
  std::vector<size_t> out(after.members.size(), no_match);
  std::vector<bool> is_taken(old.size());
  const auto take = [&](size_t k, size_t i) {
    if (out[k] != no_match || is_taken[i]) return;
    out[k] = i;
    is_taken[i] = true;
  };
  const auto at_place = [&](const JsonMember& m) {
    const auto at = m.place.line > 0 ? by_place.find(key_of(m.place)) : by_place.end();
    return at == by_place.end() ? no_match : at->second;
  };
  for (size_t k = 0; k < out.size(); k++)
    if (const size_t i = at_place(after.members[k]); i != no_match && old[i].name == after.members[k].name) take(k, i);
  for (size_t k = 0; k < out.size(); k++)
    if (const auto at = by_name.find(after.members[k].name); at != by_name.end()) take(k, at->second);
  for (size_t k = 0; k < out.size(); k++)
    if (const size_t i = at_place(after.members[k]); i != no_match) take(k, i);
  return out;
}

/// Matches the items of two runs: equal ones at both ends, then one by one.
void match_runs(const std::vector<JsonValue>& old, size_t old_begin, size_t old_end, const std::vector<JsonValue>& now,
                size_t begin, size_t end, std::vector<size_t>& out) {
  while (old_begin < old_end && begin < end && same_value(old[old_begin], now[begin])) out[begin++] = old_begin++;
  while (old_begin < old_end && begin < end && same_value(old[old_end - 1], now[end - 1])) out[--end] = --old_end;
  while (old_begin < old_end && begin < end) out[begin++] = old_begin++;
}

/// Items match if they are the same at the same place; those between them as match_runs says.
std::vector<size_t> matched_items(const TextPart& before, const JsonValue& after) {
  const std::vector<JsonValue>& old = before.json->items;
  std::map<LineAndColumn, size_t> by_place;
  for (size_t i = 0; i < old.size(); i++) by_place.emplace(key_of(old[i].place), i);
  std::vector<size_t> out(after.items.size(), no_match);
  size_t old_begin = 0, begin = 0;
  for (size_t k = 0; k < after.items.size(); k++) {
    const auto at = after.items[k].place.line > 0 ? by_place.find(key_of(after.items[k].place)) : by_place.end();
    if (at == by_place.end() || at->second < old_begin || !same_value(old[at->second], after.items[k])) continue;
    match_runs(old, old_begin, at->second, after.items, begin, k, out);
    out[k] = at->second;
    old_begin = at->second + 1;
    begin = k + 1;
  }
  match_runs(old, old_begin, old.size(), after.items, begin, after.items.size(), out);
  return out;
}

}  // namespace

std::vector<EntryMatch> matched_entries(const TextPart& before, const JsonValue& after) {
  const std::vector<size_t> entries = after.is_object() ? matched_members(before, after) : matched_items(before, after);
  // What is new stays behind the entry that it is behind in `after`.
  std::vector<std::pair<size_t, size_t>> keys;  // the entry it is or is behind, plus one; its position
  size_t last = 0;
  for (size_t k = 0; k < entries.size(); k++) {
    if (entries[k] != no_match) last = entries[k] + 1;
    keys.emplace_back(last, k);
  }
  std::ranges::sort(keys);
  std::vector<EntryMatch> out;
  for (const auto& [behind, k] : keys) out.push_back({k, entries[k]});
  return out;
}

}  // namespace terrazzo
