#include "graphs/document/excerpt.h"

#include <cstdint>

#include "graphs/document/json.h"

namespace terrazzo {

std::string excerpt(std::string_view text, size_t most) {
  if (text.size() <= most) return in_quotes(text);
  size_t end = most;
  while (end > 0 && (static_cast<uint8_t>(text[end]) & 0xC0) == 0x80) end--;
  return in_quotes(text.substr(0, end)) + " and so on";
}

}  // namespace terrazzo
