#pragma once

#include <memory>

#include "core/block_file/block_file.h"
#include "core/image/image.h"

namespace terrazzo {

/// The pixels of an image in stream `stream` of a block file, which must hold exactly its samples, row by row. Blocks
/// are read, verified and decoded on demand; those of a band of rows stay in memory. read() throws DamagedFile or
/// Error, naming the file.
std::shared_ptr<const PixelSource> stored_pixels(std::shared_ptr<const BlockFile> file, uint32_t stream, Size size,
                                                 int channels);

}  // namespace terrazzo
