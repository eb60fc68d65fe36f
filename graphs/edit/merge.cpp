#include "graphs/edit/merge.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "graphs/text/edit.h"
#include "graphs/text/format.h"

namespace terrazzo {

namespace {

/// All comments of a document, in order.
void collect_comments(const JsonValue& v, std::vector<std::string>& out) {
  const auto add = [&](const std::string& c) {
    if (!c.empty()) out.push_back(c);
  };
  for (const std::string& c : v.comments_before) add(c);
  for (const JsonValue& item : v.items) collect_comments(item, out);
  for (const JsonMember& m : v.members) collect_comments(m.value, out);
  for (const std::string& c : v.comments_inside) add(c);
  add(v.comment_after);
}

std::vector<std::string> comments_of(const JsonValue& v) {
  std::vector<std::string> out;
  collect_comments(v, out);
  return out;
}

bool same_or_none(const JsonValue* a, const JsonValue* b) {
  return a && b ? same_value(*a, *b) : a == b;
}

class Merge {
 public:
  std::string conflict;

  /// Changes `theirs` by what differs from `base` in `mine`.
  void objects(const JsonValue& base, const JsonValue& mine, JsonValue& theirs, std::vector<std::string>& path) {
    for (size_t i = 0; i < mine.members.size(); i++) {
      const JsonMember& m = mine.members[i];
      path.push_back(m.name);
      member(base.find(m.name), &m.value, theirs, m, i > 0 ? mine.members[i - 1].name : "", path);
      path.pop_back();
    }
    for (const JsonMember& m : base.members) {
      if (mine.find(m.name)) continue;
      path.push_back(m.name);
      const JsonValue* there = theirs.find(m.name);
      if (there && !same_value(m.value, *there)) refuse(path, nullptr, there);
      std::erase_if(theirs.members, [&](const JsonMember& t) { return t.name == m.name; });
      path.pop_back();
    }
  }

 private:
  void refuse(const std::vector<std::string>& path, const JsonValue* mine, const JsonValue* theirs) {
    const auto shown = [](const JsonValue* v) {
      if (!v) return std::string("nothing");
      constexpr size_t longest = 60;
      const std::string text = compact(*v);
      return text.size() <= longest ? text : found(*v);
    };
    if (conflict.empty())
      conflict = fmt::format("both have changed {}: here to {}, elsewhere to {}", pointer_of(path), shown(mine),
                             shown(theirs));
  }

  void member(const JsonValue* base, const JsonValue* mine, JsonValue& theirs, const JsonMember& m,
              const std::string& previous, std::vector<std::string>& path) {
    JsonValue* there = theirs.find(m.name);
    if (same_or_none(base, mine) || same_or_none(mine, there)) return;
    if (mine->is_object() && there && there->is_object() && (!base || base->is_object())) {
      static const JsonValue none = JsonValue::empty_object();
      objects(base ? *base : none, *mine, *there, path);
    } else if (!same_or_none(base, there)) {
      refuse(path, mine, there);
    } else if (there) {
      *there = *mine;
    } else {
      auto at = theirs.members.end();
      for (auto t = theirs.members.begin(); t != theirs.members.end(); ++t)
        if (t->name == previous) at = t + 1;
      theirs.members.insert(at, {m.name, {}, *mine});
    }
  }
};

}  // namespace

MergedText merged(std::string_view base, std::string_view mine, std::string_view theirs) {
  if (base == mine) return {std::string(theirs), ""};
  if (base == theirs || mine == theirs) return {std::string(mine), ""};
  const ParsedJson a = parse_json(base), b = parse_json(mine), c = parse_json(theirs);
  if (!a.value || !b.value || !c.value || !a.problems.empty() || !b.problems.empty() || !c.problems.empty())
    return {"", "both have changed the text, and not all of it is JSON"};
  if (!a.value->is_object() || !b.value->is_object() || !c.value->is_object())
    return {"", "both have changed the whole document"};
  Merge merge;
  JsonValue out = *c.value;
  std::vector<std::string> path;
  merge.objects(*a.value, *b.value, out, path);
  if (!merge.conflict.empty()) return {"", merge.conflict};
  std::string text = with_changes(theirs, out);
  // Comments that were written in `mine` must not get lost.
  const std::vector<std::string> before = comments_of(*a.value), now = comments_of(json_in(text));
  for (const std::string& c : comments_of(*b.value))
    if (std::ranges::find(before, c) == before.end() && std::ranges::find(now, c) == now.end())
      return {"", "both have changed the text, one its comments"};
  return {std::move(text), ""};
}

}  // namespace terrazzo
