#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "runner/editor/previews/runs.h"

namespace terrazzo {

/// The edited document as the server needs it: requests and answers of the protocol. All functions are thread-safe, and
/// throw Error with a message for the user; about() is the JSON pointer of the part concerned.
class DocumentAccess {
 public:
  using Json = nlohmann::ordered_json;
  virtual ~DocumentAccess() = default;

  virtual int64_t revision() const = 0;
  virtual std::string text() const = 0;
  virtual std::filesystem::path file() const = 0;
  virtual bool is_read_only() const = 0;
  virtual Json state(const RunFindings& findings) const = 0;

  virtual Json edit(const Json& request) = 0;
  virtual Json undo() = 0;
  virtual Json redo() = 0;
  virtual Json format() = 0;
  virtual Json resolve(const Json& request) = 0;
  virtual Json copy(const Json& request) const = 0;
  virtual Json diff() const = 0;
  virtual Json preset(const Json& request) const = 0;
  virtual Json types() const = 0;

  /// To be called about twice a second. Whether the state has changed.
  virtual bool look_at_disk() = 0;
};

}  // namespace terrazzo
