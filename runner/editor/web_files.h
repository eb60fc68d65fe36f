#pragma once

#include <string_view>

namespace terrazzo {

/// A file of the editor's page, embedded in the program: runner/editor/web/dist.
struct WebFile {
  std::string_view path;  ///< "/app.js"
  std::string_view type;
  std::string_view text;
};

/// Null if there is none.
const WebFile* find_web_file(std::string_view path);

}  // namespace terrazzo
