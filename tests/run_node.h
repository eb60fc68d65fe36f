#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/node/node.h"

namespace terrazzo::test {

/// What a node made.
struct NodeRun {
  std::map<std::string, Value> outputs;
  std::vector<std::string> notes;
  template <typename T>
  std::shared_ptr<const T> get(const std::string& port) const {
    return std::get<std::shared_ptr<const T>>(outputs.at(port));
  }
  /// Whether one of the notes contains the text.
  bool says(const std::string& text) const;
};

/// Runs one node by itself: defaults filled in, images converted to materials where the port wants one, staged files
/// renamed. Fails the test if a name is unknown, a required parameter or input is missing, or an output is not made.
NodeRun run_node(const std::string& type, const Params& params = {},
                 const std::map<std::string, std::vector<Value>>& inputs = {});

/// What the Error that a node throws is about and says, as "about: message"; empty if it throws none.
std::string error_of(const std::string& type, const Params& params,
                     const std::map<std::string, std::vector<Value>>& inputs = {});

/// A small float image made from a function of (x, y, channel).
ImagePtr make_image(Size size, int channels, const std::function<float(int, int, int)>& value,
                    Semantic semantic = Semantic::data, const std::string& color_space = "raw");

/// An empty folder that is removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace terrazzo::test
