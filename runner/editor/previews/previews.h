#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "runner/api/session.h"
#include "runner/editor/previews/coarse_look.h"
#include "runner/editor/previews/grace.h"
#include "runner/editor/previews/graph_loading.h"
#include "runner/editor/previews/picture_board.h"

namespace terrazzo {

/// A node of a loaded graph that somebody wants to see.
struct PreviewTarget {
  Wish wish;
  std::string node;
  Digest recipe;  ///< see recipe_of
};

/// What is to be shown, sorted: what only has to be read or is made while it is read, and what has to be computed, what
/// comes first first.
struct PreviewTargets {
  std::vector<PreviewTarget> ready, slow;
};

/// Gets what tabs want to see. Thread-safe.
class Previews {
 public:
  /// Borrows everything.
  Previews(Session& session, const Sandbox& sandbox, PictureBoard& board, PublishEvent publish);

  /// Leaves out what is shown already, sinks, and what cannot run. Throws GraphError and Error if nothing can be
  /// planned.
  PreviewTargets targets_of(const EditedGraph& graph, const std::string& text, const std::vector<Wish>& wishes);
  void show_ready(const EditedGraph& graph, const std::vector<PreviewTarget>& targets,
                  const std::atomic<bool>& cancelled);
  /// Computes the first target, and shows it; before that what it will roughly be, and so the others that depend on it.
  /// Runs no sink. Whether it succeeded. Tells `time` what was shown, and ends when that says so.
  bool make(const EditedGraph& graph, const std::vector<PreviewTarget>& targets, GracePeriod& time);

 private:
  class CoarseLook;
  bool show_kept(const RunResult& result, const std::vector<PreviewTarget>& targets,
                 const std::atomic<bool>& cancelled);

  Session& session_;
  const Sandbox& sandbox_;
  PictureBoard& board_;
  PublishEvent publish_;
  ExemplarPictures exemplars_;
};

}  // namespace terrazzo
