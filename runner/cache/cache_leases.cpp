#include "runner/cache/cache_leases.h"

#include <cerrno>
#include <condition_variable>
#include <iterator>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "runner/cache/lease_folder.h"

namespace terrazzo {

namespace fs = std::filesystem;

class Leases::State {
 public:
  using Clock = std::chrono::steady_clock;

  State(fs::path folder, LeaseTimes times) : folder_(std::move(folder)), times_(times) {}

  fs::path path_of(const Digest& key) const { return folder_ / key.hex(); }
  const fs::path& folder() const { return folder_; }

  void add(const Digest& key, const LeaseHolder& holder) {
    const std::lock_guard lock(mutex_);
    held_[key] = holder;
    if (!thread_.joinable()) thread_ = std::thread([this] { renew(); });
  }

  void release(const Digest& key, const std::string& who) {
    const std::lock_guard lock(mutex_);
    const auto at = held_.find(key);
    if (at == held_.end() || at->second.who != who) return;  // has been taken over
    release_lease(path_of(key), at->second);
    held_.erase(at);
  }

  /// Whether a holder is dead, or has not renewed the lease for `expiry` since it was first seen.
  bool is_expired(const Digest& key, const LeaseHolder& holder) {
    if (is_dead(holder.who)) return true;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    const auto [at, is_new] = seen_.try_emplace(key, Seen{holder, now});
    if (!is_new && at->second.holder != holder) at->second = {holder, now};
    return now - at->second.since >= times_.expiry;
  }

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

 private:
  struct Seen {
    LeaseHolder holder;
    Clock::time_point since;
  };

  void renew() {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, times_.beat, [this] { return stopping_; }))
      for (auto at = held_.begin(); at != held_.end();)
        at = renew_lease(path_of(at->first), at->second) ? std::next(at) : held_.erase(at);
  }

  const fs::path folder_;
  const LeaseTimes times_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<Digest, LeaseHolder> held_;
  std::map<Digest, Seen> seen_;
  std::thread thread_;
  bool stopping_ = false;
};

class Leases::Held : public Lease {
 public:
  Held(std::shared_ptr<State> state, const Digest& key, std::string who)
      : state_(std::move(state)), key_(key), who_(std::move(who)) {}
  ~Held() override { state_->release(key_, who_); }

 private:
  std::shared_ptr<State> state_;
  Digest key_;
  std::string who_;
};

Leases::Leases(fs::path folder, LeaseTimes times) : state_(std::make_shared<State>(std::move(folder), times)) {}

Leases::~Leases() {
  state_->stop();
}

LeaseAttempt Leases::try_lease(const Digest& key) {
  const fs::path path = state_->path_of(key);
  constexpr int most_tries = 100;  // other holders may interfere, but not forever
  for (int i = 0; i < most_tries; i++) {
    if (const std::optional<LeaseHolder> holder = holder_of(path)) {
      if (!state_->is_expired(key, *holder)) return {nullptr, true};
      take_lease_away(path, *holder);
    }
    const LeaseHolder mine{new_lease_holder()};
    if (claim_lease(path, mine)) {
      state_->add(key, mine);
      return {std::make_shared<Held>(state_, key, mine.who), false};
    }
    if (errno != EEXIST) return {};
  }
  return {};
}

bool Leases::is_taken(const Digest& key) {
  const std::optional<LeaseHolder> holder = holder_of(state_->path_of(key));
  return holder && !state_->is_expired(key, *holder);
}

namespace {

bool is_a_day_old(const fs::path& path) {
  std::error_code missing;
  const fs::file_time_type written = fs::last_write_time(path, missing);
  return !missing && fs::file_time_type::clock::now() - written > std::chrono::hours(24);
}

/// The owner of a temporary folder ".claim-WHO", or ".gone-WHO" in earlier versions.
std::string maker_of(const std::string& name) {
  return name.substr(name.find('-') + 1);
}

}  // namespace

void Leases::remove_abandoned() {
  std::vector<fs::path> all;
  std::error_code ended;
  for (fs::directory_iterator at(state_->folder(), ended), end; !ended && at != end; at.increment(ended))
    all.push_back(at->path());
  for (const fs::path& path : all) {
    const std::string name = path.filename().string();
    const std::optional<LeaseHolder> holder = holder_of(path);
    const bool is_passing = name.starts_with('.');
    const bool is_free = is_passing ? is_dead(maker_of(name)) : !holder || is_dead(holder->who);
    if (!is_free && !is_a_day_old(path)) continue;
    if (holder && !is_passing) {
      take_lease_away(path, *holder);
      fs::remove(path, ended);  // unless another has come
    } else {
      fs::remove_all(path, ended);
    }
  }
}

}  // namespace terrazzo
