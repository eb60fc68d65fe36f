#include "tests/texts.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <doctest/doctest.h>

namespace terrazzo::test {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

void replace_text(const fs::path& path, const std::string& text) {
  fs::remove(path);
  write_text(path, text);
}

std::vector<std::string> listing(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& e : fs::directory_iterator(folder)) names.push_back(e.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void check_golden_message(const fs::path& document, const std::string& found, const fs::path& list) {
  const fs::path golden = fs::path(document).replace_extension(".txt");
  if (std::getenv("TERRAZZO_UPDATE_GOLDEN")) write_text(golden, found + "\n");
  CHECK(found != "");
  CHECK(found + "\n" == read_text(golden));
  CHECK_MESSAGE(contains(read_text(list), "`" + document.stem().string() + "`"), "not listed in " << list.string());
}

}  // namespace terrazzo::test
