#include "core/image_io/png_codec.h"

#include <doctest/doctest.h>

#include "tests/odd_images.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

template <typename T>
std::vector<T> all_values(ImageDecoder& decoder) {
  std::vector<T> out(size_t(decoder.header().size.area()) * decoder.header().channels.size());
  decoder.read(decoder.header().depth, out.data());
  return out;
}

}  // namespace

TEST_CASE("PNG files of every kind are read as OpenImageIO reads them") {
  struct Kind {
    int bits, color_type;
    Bytes row;  ///< of two pixels
    Bytes palette;
  };
  const std::vector<Kind> kinds = {{1, 0, {0x80}, {}},
                                   {2, 0, {0x60}, {}},
                                   {4, 0, {0x3a}, {}},
                                   {8, 0, {7, 200}, {}},
                                   {16, 0, {1, 2, 3, 4}, {}},
                                   {8, 2, {1, 2, 3, 4, 5, 6}, {}},
                                   {16, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, {}},
                                   {1, 3, {0x40}, {9, 8, 7, 6, 5, 4}},
                                   {8, 3, {1, 0}, {9, 8, 7, 6, 5, 4}},
                                   {8, 4, {1, 2, 3, 4}, {}},
                                   {16, 4, {1, 2, 3, 4, 5, 6, 7, 8}, {}},
                                   {8, 6, {1, 2, 3, 0, 5, 6, 7, 128}, {}},
                                   {16, 6, {1, 2, 3, 4, 5, 6, 0, 0, 9, 8, 7, 6, 5, 4, 3, 2}, {}}};
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "kind.png";
  for (const Kind& kind : kinds) {
    CAPTURE(kind.bits);
    CAPTURE(kind.color_type);
    write_bytes(path, make_png({2, 1}, kind.bits, kind.color_type, {kind.row}, kind.palette));
    const auto ours = open_png(path), theirs = image_libraries().open_image(path.string());
    REQUIRE(ours);
    CHECK(ours->header().size == theirs->header().size);
    REQUIRE(ours->header().channels.size() == theirs->header().channels.size());
    REQUIRE(ours->header().depth == theirs->header().depth);
    if (ours->header().depth == Depth::u8)
      CHECK(all_values<uint8_t>(*ours) == all_values<uint8_t>(*theirs));
    else
      CHECK(all_values<uint16_t>(*ours) == all_values<uint16_t>(*theirs));
  }
}

TEST_CASE("a file that is no PNG is left to other decoders") {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "a.png", {1, 2, 3});
  CHECK(open_png(folder.path() / "a.png") == nullptr);
  CHECK(open_png(folder.path() / "missing.png") == nullptr);
}
