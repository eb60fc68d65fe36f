#include "runner/editor/previews/picture_store.h"

#include <string>

#include <doctest/doctest.h>

#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

PictureFile file_of(uint8_t content, size_t bytes = 1000) {
  return {"image/png", std::vector<uint8_t>(bytes, content)};
}

}  // namespace

TEST_CASE("the pictures used longest ago make room for new ones") {
  PictureStore store(3500);
  const std::string first = store.add(file_of(1)), second = store.add(file_of(2)), third = store.add(file_of(3));
  CHECK(store.add(file_of(1)) == first);
  CHECK(store.find(first));
  const std::string fourth = store.add(file_of(4));
  CHECK(!store.find(second));
  for (const std::string& kept : {first, third, fourth}) CHECK(store.find(kept));
  // However large, the newest can be fetched.
  const std::string large = store.add(file_of(5, 10'000));
  CHECK(store.find(large)->bytes.size() == 10'000);
  CHECK(!store.find(first));
  for (const char* unknown : {"", "../x", "0123456789abcdef0123456789abcdef"}) CHECK(!store.find(unknown));
}

TEST_CASE("only the images of the newest pictures are held") {
  PictureStore store;
  const ImagePtr image = Image::from_floats({.size = {1, 1}}, {0.5f});
  std::vector<std::string> digests;
  for (int i = 0; i < 40; i++) digests.push_back(store.add(file_of(uint8_t(i)), image));
  CHECK(store.image(digests.back()) == image);
  CHECK(store.image(digests.front()) == nullptr);
  CHECK(store.find(digests.front()));
  CHECK(image.use_count() < 40);
}
