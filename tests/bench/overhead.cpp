// What a run costs whose results are all there: opening, checking, planning and running a graph from C++.
// Usage: terrazzo_overhead GRAPH.json [NAME=VALUE ...]      (runs it once, then 101 times each; TERRAZZO_CACHE is used)
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>

#include "runner/api/session.h"

using namespace terrazzo;

namespace {

/// The median, which other programs change least.
double milliseconds(const std::function<void()>& act) {
  std::array<double, 101> taken{};
  for (double& t : taken) {
    const auto start = std::chrono::steady_clock::now();
    act();
    t = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  std::nth_element(taken.begin(), taken.begin() + taken.size() / 2, taken.end());
  return taken[taken.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: terrazzo_overhead GRAPH.json [NAME=VALUE ...]\n");
    return 2;
  }
  const auto open = [&] {
    Job job = Job::open(argv[1]);
    for (int i = 2; i < argc; i++) {
      const std::string text = argv[i];
      const size_t equals = text.find('=');
      if (equals != text.npos) job.set_text(text.substr(0, equals), text.substr(equals + 1));
    }
    return job;
  };
  try {
    Session session;
    const Job job = open();
    const CheckedJob checked = job.checked();
    if (!session.run(checked).ok()) return 1;
    std::printf("| open | check | plan | run | all of it | in ms\n| %.2f | %.2f | %.2f | %.2f | %.2f |\n",
                milliseconds([&] { open(); }), milliseconds([&] { job.checked(); }),
                milliseconds([&] { session.plan(checked); }), milliseconds([&] { session.run(checked); }),
                milliseconds([&] { session.run(open().checked()); }));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
