#include "core/block_file/bytes.h"

namespace terrazzo {

void ByteWriter::append(const void* data, size_t size) {
  const auto* bytes = static_cast<const uint8_t*>(data);
  bytes_.insert(bytes_.end(), bytes, bytes + size);
}

}  // namespace terrazzo
