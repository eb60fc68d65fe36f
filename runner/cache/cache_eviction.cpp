#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/portable_math.h"
#include "core/file/atomic_file.h"
#include "core/node/serialize.h"
#include "runner/cache/cache.h"
#include "runner/cache/cache_records.h"
#include "runner/cache/cache_state.h"
#include "runner/cache/cache_total.h"

namespace terrazzo {

namespace {

/// The fill level after an eviction, which leaves room for some runs before the next.
constexpr double filled_after_eviction = 0.9;
constexpr double half_life_days = 7;
/// Small entries without known users are kept this long after their last use.
constexpr double kept_unused_days = 30;
/// Removals per hold of the eviction lock, which blocks readers of values.
constexpr size_t removals_at_once = 64;

double days_unused(const CacheEntry& entry, int64_t now) {
  return std::max(0.0, double(now - entry.used_ns) / double(24 * 3600 * ns_per_second));
}

/// The value of a byte of the entry: seconds to recompute it, decreasing with the time since its last use.
double worth(const CacheEntry& entry, int64_t now) {
  constexpr double least_seconds = 1e-3;
  double seconds = 0;
  try {
    seconds = summarize_value_file(entry.path).seconds;
  } catch (const Error&) {
    return -1;
  }
  const double discount = portable::pow(0.5, days_unused(entry, now) / half_life_days);
  return std::max(seconds, least_seconds) * discount / double(std::max<uint64_t>(1, entry.bytes));
}

std::vector<CacheEntry> cheapest_first(const std::vector<CacheEntry>& values) {
  const int64_t now = now_ns();
  std::vector<std::pair<double, const CacheEntry*>> order;
  for (const CacheEntry& e : values) order.push_back({worth(e, now), &e});
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.first, a.second->used_ns, a.second->name) <
           std::tuple(b.first, b.second->used_ns, b.second->name);
  });
  std::vector<CacheEntry> sorted;
  for (const auto& [worth, entry] : order) sorted.push_back(*entry);
  return sorted;
}

std::vector<CacheEntry> of_kind(const CacheScan& scan, EntryKind kind) {
  std::vector<CacheEntry> found;
  std::copy_if(scan.entries.begin(), scan.entries.end(), std::back_inserter(found),
               [kind](const CacheEntry& e) { return e.kind == kind; });
  return found;
}

uint64_t remove(const std::filesystem::path& path, uint64_t bytes) {
  return ::unlink(path.c_str()) == 0 ? bytes : 0;
}

/// Removes unpinned values in the given order until `enough` bytes are freed. Returns the bytes freed.
uint64_t remove_values(const CacheFolder& folder, const std::vector<CacheEntry>& values, uint64_t enough) {
  uint64_t freed = 0;
  for (size_t first = 0; first < values.size() && freed < enough; first += removals_at_once) {
    const EvictionLock lock(folder.lock());
    const LivePins pins = read_live_pins(folder.pins());
    const size_t end = std::min(values.size(), first + removals_at_once);
    for (size_t i = first; i < end && freed < enough; i++)
      if (!pins.values.count(values[i].name)) freed += remove(values[i].path, values[i].bytes);
  }
  return freed;
}

/// Removes pins and half-written files of dead processes.
uint64_t remove_abandoned(const CacheFolder& folder, const std::vector<TemporaryEntry>& temporaries) {
  const EvictionLock lock(folder.lock());
  const LivePins pins = read_live_pins(folder.pins());
  uint64_t freed = 0;
  for (const TemporaryEntry& t : temporaries)
    if (!pins.owners.count(t.owner)) freed += remove(t.path, t.bytes);
  return freed;
}

/// The values that a stage's record names; none if it cannot be read.
std::vector<Digest> values_of(const CacheEntry& stage) {
  std::vector<Digest> values;
  try {
    const auto bytes = CacheFolder::read(stage.path);
    if (bytes)
      for (const auto& [port, value] : stage_from_bytes(stage.name, *bytes).outputs) values.push_back(value);
  } catch (const Error&) {
    // Counts as missing.
  }
  return values;
}

bool is_stored(const CacheFolder& folder, const Digest& value) {
  return ::access(folder.path_of(EntryKind::value, value).c_str(), F_OK) == 0;
}

/// Whether any value of a stage's record still exists. False for unreadable records.
bool has_values_left(const CacheFolder& folder, const CacheEntry& stage) {
  const std::vector<Digest> values = values_of(stage);
  return std::any_of(values.begin(), values.end(), [&](const Digest& v) { return is_stored(folder, v); });
}

/// Whether a stage's record names some of these values, and none of its values exists any more.
bool describes_any(const CacheFolder& folder, const CacheEntry& stage, const std::set<Digest>& evicted) {
  const std::vector<Digest> values = values_of(stage);
  return std::any_of(values.begin(), values.end(), [&](const Digest& v) { return evicted.count(v) == 1; }) &&
         std::none_of(values.begin(), values.end(), [&](const Digest& v) { return is_stored(folder, v); });
}

}  // namespace

CacheStatus Cache::status() {
  const CacheScan scan = state_->folder.scan();
  CacheStatus status{scan.bytes(), state_->limit.bytes, 0, 0, 0, state_->limit.from};
  for (const CacheEntry& e : scan.entries) {
    status.stages += e.kind == EntryKind::stage;
    status.values += e.kind == EntryKind::value;
    status.histories += e.kind == EntryKind::history;
  }
  return status;
}

namespace {

/// Removes small entries that have not been used for long, except records of existing values.
uint64_t remove_forgotten(const CacheFolder& folder, const CacheScan& scan) {
  const int64_t now = now_ns();
  uint64_t freed = 0;
  for (const CacheEntry& e : scan.entries) {
    if (e.kind == EntryKind::value || days_unused(e, now) < kept_unused_days) continue;
    if (e.kind != EntryKind::stage || !has_values_left(folder, e)) freed += remove(e.path, e.bytes);
  }
  return freed;
}

/// Reduces the cache from `total` bytes to `target`: removes values, then the records of stages without remaining
/// values, then, if necessary, other small entries, least recently used first.
uint64_t evict(const CacheFolder& folder, const CacheScan& scan, uint64_t total, uint64_t target) {
  const uint64_t excess = total - target;
  std::vector<CacheEntry> values = cheapest_first(of_kind(scan, EntryKind::value));
  uint64_t freed = remove_values(folder, values, excess);
  std::set<Digest> evicted;
  for (const CacheEntry& e : values)
    if (::access(e.path.c_str(), F_OK) != 0) evicted.insert(e.name);
  std::vector<const CacheEntry*> others;
  for (const CacheEntry& e : scan.entries) {
    if (e.kind == EntryKind::stage && describes_any(folder, e, evicted))
      freed += remove(e.path, e.bytes);
    else if (e.kind != EntryKind::value)
      others.push_back(&e);
  }
  std::sort(others.begin(), others.end(), [](const CacheEntry* a, const CacheEntry* b) {
    return std::tuple(a->used_ns, a->name) < std::tuple(b->used_ns, b->name);
  });
  for (const CacheEntry* e : others) {
    if (freed >= excess) break;
    if (e->kind != EntryKind::stage || !has_values_left(folder, *e)) freed += remove(e->path, e->bytes);
  }
  return freed;
}

}  // namespace

CacheCollection Cache::collect_all() {
  CacheFolder& folder = state_->folder;
  const uint64_t limit = state_->limit.bytes;
  folder.take_written();
  const int64_t begun = now_ns();
  const CacheScan scan = folder.scan();
  terrazzo::remove_abandoned(folder.history());
  state_->leases.remove_abandoned();
  uint64_t freed = remove_abandoned(folder, scan.temporaries);
  freed += remove_forgotten(folder, scan);
  const uint64_t total = scan.bytes() - freed;
  if (total > limit) freed += evict(folder, scan, total, uint64_t(double(limit) * filled_after_eviction));
  if (state_->pins.failure() == 0) {
    const EvictionLock lock(folder.lock());
    write_total(folder.total(), {scan.bytes() - freed, begun}, state_->pins.owner());
  }
  return {freed, scan.entries.size()};
}

uint64_t Cache::collect() {
  return collect_all().freed;
}

CacheCollection Cache::collect_if_due() {
  CacheFolder& folder = state_->folder;
  if (state_->pins.failure() != 0) return {};  // nothing can be removed
  {
    const EvictionLock lock(folder.lock());
    const bool all_told = read_live_pins(folder.pins()).dead == 0;
    std::optional<CacheTotal> total = read_total(folder.total());
    if (total && all_told) {
      const uint64_t written = folder.take_written();
      total->bytes += written;
      if (written > 0) write_total(folder.total(), *total, state_->pins.owner());
      if (total->bytes <= state_->limit.bytes) return {};
    }
  }
  return collect_all();
}

uint64_t Cache::clear() {
  const CacheFolder& folder = state_->folder;
  const CacheScan scan = folder.scan();
  state_->leases.remove_abandoned();
  uint64_t freed = remove_abandoned(folder, scan.temporaries);
  freed += remove_values(folder, of_kind(scan, EntryKind::value), scan.bytes() + 1);
  for (const CacheEntry& e : scan.entries)
    if (e.kind == EntryKind::file || e.kind == EntryKind::history ||
        (e.kind == EntryKind::stage && !has_values_left(folder, e)))
      freed += remove(e.path, e.bytes);
  return freed;
}

}  // namespace terrazzo
