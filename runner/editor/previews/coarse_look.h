#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "runner/api/session.h"
#include "runner/editor/previews/picture_board.h"

namespace terrazzo {

/// Small pictures of exemplars, through which coarse uv maps are shown. Thread-safe.
class ExemplarPictures {
 public:
  /// That of an output of a node, which is run unless it takes long; null if there is none.
  ImagePtr find(const Graph& graph, const Wire& exemplar, Session& session, const Sandbox& sandbox,
                const std::atomic<bool>& cancelled);

 private:
  std::mutex mutex_;
  std::map<Digest, ImagePtr> pictures_;  // by the value's digest
};

/// What a uv map made by `node` is resolved with: the material that a node reads beside it, or else the nearest source
/// behind it; nullopt if there is none.
std::optional<Wire> exemplar_of(const Graph& graph, const std::string& node);

/// Whether `node` shows what a uv map of `maker` is resolved to.
bool resolves(const Graph& graph, const std::string& node, const std::string& maker);

/// Whether a stage may give coarse results, and has to run.
bool may_be_previewed(const Stage& stage);

}  // namespace terrazzo
