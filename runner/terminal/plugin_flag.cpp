#include "runner/terminal/plugin_flag.h"

#include <string_view>

#include "runner/api/plugin.h"
#include "runner/terminal/usage.h"

namespace terrazzo {

CommandLine without_plugins(int argc, const char* const* argv) {
  constexpr std::string_view flag = "--plugin", with_file = "--plugin=";
  CommandLine out;
  for (int i = 0; i < argc; i++) {
    const std::string_view word = argv[i];
    if (word == flag) {
      if (++i == argc) throw UsageError("--plugin takes the file of a plug-in, such as --plugin libmine.so");
      out.plugins.emplace_back(argv[i]);
    } else if (word.starts_with(with_file)) {
      out.plugins.emplace_back(word.substr(with_file.size()));
    } else {
      out.words.push_back(argv[i]);
    }
  }
  return out;
}

void load_plugins(const std::vector<std::string>& files) {
  as_usage([&] {
    load_plugins_of_environment();
    for (const std::string& f : files) load_plugin(f);
  });
}

}  // namespace terrazzo
