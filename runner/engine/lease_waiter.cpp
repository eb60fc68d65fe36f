#include "runner/engine/lease_waiter.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace terrazzo {

LeaseWaiter::LeaseWaiter(Taken taken, OnReady give_back, const std::atomic<bool>* cancelled)
    : taken_(std::move(taken)), on_ready_(std::move(give_back)), cancelled_(cancelled) {}

LeaseWaiter::~LeaseWaiter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void LeaseWaiter::add(StageJobPtr job) {
  const std::lock_guard lock(mutex_);
  Entry entry;
  entry.job = std::move(job);
  entry.wait.start = Clock::now();
  while (rows_.count(entry.wait.row) == 1) entry.wait.row++;
  rows_.insert(entry.wait.row);
  entry.pause = first_pause;
  entry.due = entry.wait.start + entry.pause;
  entries_.push_back(std::move(entry));
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  changed_.notify_one();
}

void LeaseWaiter::look_now() {
  const std::lock_guard lock(mutex_);
  if (rows_.empty()) return;
  look_now_ = true;
  changed_.notify_one();
}

void LeaseWaiter::give_all_back() {
  const std::lock_guard lock(mutex_);
  give_all_back_ = true;
  changed_.notify_one();
}

LeaseWaiter::Clock::time_point LeaseWaiter::next_look() const {
  Clock::time_point next = Clock::now() + cancel_pause;
  for (const Entry& e : entries_) next = std::min(next, e.due);
  return next;
}

std::vector<LeaseWaiter::Entry> LeaseWaiter::take_due(bool all) {
  const Clock::time_point now = Clock::now();
  const auto due =
      std::stable_partition(entries_.begin(), entries_.end(), [&](const Entry& e) { return !all && e.due > now; });
  std::vector<Entry> taken(std::make_move_iterator(due), std::make_move_iterator(entries_.end()));
  entries_.erase(due, entries_.end());
  return taken;
}

std::vector<LeaseWaiter::Entry> LeaseWaiter::look_at(std::vector<Entry> due, bool give_all_back,
                                                     std::vector<int>& free_rows) {
  std::vector<Entry> still;
  for (Entry& e : due) {
    if (!give_all_back && taken_(*e.job)) {
      e.pause = std::min<Clock::duration>(2 * e.pause, longest_pause);
      e.due = Clock::now() + e.pause;
      still.push_back(std::move(e));
      continue;
    }
    e.wait.end = Clock::now();
    free_rows.push_back(e.wait.row);
    on_ready_(std::move(e.job), e.wait);
  }
  return still;
}

void LeaseWaiter::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (entries_.empty()) {
      look_now_ = false;
      if (stop_) return;
      changed_.wait(lock, [this] { return stop_ || !entries_.empty(); });
      continue;
    }
    changed_.wait_until(lock, next_look(), [this] { return stop_ || give_all_back_ || look_now_; });
    const bool give_all_back = stop_ || give_all_back_ || (cancelled_ && cancelled_->load());
    std::vector<Entry> due = take_due(std::exchange(look_now_, false) || give_all_back);
    std::vector<int> free_rows;
    lock.unlock();
    std::vector<Entry> still = look_at(std::move(due), give_all_back, free_rows);
    lock.lock();
    for (const int row : free_rows) rows_.erase(row);
    std::move(still.begin(), still.end(), std::back_inserter(entries_));
  }
}

}  // namespace terrazzo
