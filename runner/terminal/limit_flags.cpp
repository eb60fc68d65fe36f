#include "runner/terminal/limit_flags.h"

#include <charconv>

#include <fmt/format.h>

#include "core/image/image_limits.h"
#include "runner/terminal/usage.h"

namespace terrazzo {

void LimitFlags::apply() const {
  if (!memory.empty()) set_memory_budget(parse_bytes(memory, "--memory"));
  if (max_pixels > 0) set_most_pixels(max_pixels);
  if (!max_bytes.empty()) set_most_bytes(int64_t(parse_bytes(max_bytes, "--max-bytes")));
}

void add_limit_flags(Command& command, LimitFlags& flags) {
  command
      .add_option("--memory", &flags.memory,
                  "Memory to stay within, such as 2G; half of the machine's if not given. Images that do not fit are "
                  "read into a temporary file")
      .takes("SIZE");
  command
      .add_option("--max-pixels", &flags.max_pixels,
                  "Read no image of more pixels. Default: as many as fit into half of the machine's memory, or into 16 "
                  "times --memory")
      .takes("N")
      .checked_by([](const std::string& text) {
        int64_t pixels = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, pixels);
        if (error == std::errc() && stop == end && pixels > 0) return std::string();
        return fmt::format("expected a number of pixels of at least 1, such as 100000000, found \"{}\"", text);
      });
  command
      .add_option("--max-bytes", &flags.max_bytes,
                  "Read no image file of more bytes, such as 2G; an eighth of the memory to stay within if not given, "
                  "but at least 256M")
      .takes("SIZE");
}

}  // namespace terrazzo
