#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "graphs/text/format.h"
#include "graphs/text/read_document.h"
#include "graphs/values/convert.h"
#include "graphs/values/variations.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

struct Row {
  int line = 0;
  std::vector<std::string> cells;
  std::vector<Place> places;
};

constexpr size_t most_cells = 1000000;  // a cell is many times as large in memory as in the file

[[noreturn]] void refuse_cells(const fs::path& file) {
  throw Error(fmt::format("{}: expected at most {} values in a table, found more", file.string(), most_cells));
}

/// RFC 4180: cells in double quotes may hold commas, line breaks and, doubled, double quotes. Empty lines are skipped.
std::vector<Row> rows_of(const fs::path& file, const std::string& text) {
  std::vector<Row> out;
  size_t cells = 0;
  int line = 1;
  size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0, line_begins = at;
  while (at < text.size()) {
    Row row{line, {}, {}};
    for (bool more = true; more;) {
      std::string cell;
      row.places.push_back({line, int(at - line_begins) + 1});
      if (at < text.size() && text[at] == '"') {
        const int opened = line;
        for (at++;; at++) {
          if (at >= text.size())
            throw Error(fmt::format("{}:{}: a quote is opened and not closed", file.string(), opened));
          if (text[at] == '\n') {
            line++;
            line_begins = at + 1;
          }
          if (text[at] != '"') {
            cell += text[at];
          } else if (at + 1 < text.size() && text[at + 1] == '"') {
            cell += text[at++];
          } else {
            break;
          }
        }
        at++;
      } else {
        while (at < text.size() && text[at] != ',' && text[at] != '\n' && text[at] != '\r') cell += text[at++];
      }
      row.cells.push_back(std::move(cell));
      if (++cells > most_cells) refuse_cells(file);
      more = at < text.size() && text[at] == ',';
      if (more) at++;
    }
    if (at < text.size() && text[at] == '\r') at++;
    if (at < text.size() && text[at] != '\n')
      throw Error(
          fmt::format("{}:{}: expected a comma or the end of the line after a cell in quotes", file.string(), line));
    at++;
    line++;
    line_begins = at;
    if (row.cells.size() > 1 || !row.cells.front().empty()) out.push_back(std::move(row));
  }
  return out;
}

std::vector<Variation> read_csv(const fs::path& file, const std::string& text) {
  const std::vector<Row> rows = rows_of(file, text);
  if (rows.size() < 2)
    throw Error(fmt::format("{}: expected a line of names and at least one line of values", file.string()));
  std::vector<Variation> out;
  const std::vector<std::string>& names = rows.front().cells;
  for (size_t c = 0; c < names.size(); c++)
    if (names[c].empty())
      throw Error(fmt::format("{}:{}: column {} has no name", file.string(), rows.front().line, c + 1));
  for (size_t c = 0; c < names.size(); c++)
    if (const auto first = size_t(std::ranges::find(names, names[c]) - names.begin()); first != c)
      throw Error(fmt::format("{}:{}: columns {} and {} are both named {}; a value is given once", file.string(),
                              rows.front().line, first + 1, c + 1, in_quotes(names[c])));
  for (size_t r = 1; r < rows.size(); r++) {
    if (rows[r].cells.size() != names.size())
      throw Error(fmt::format("{}:{}: expected {} cells as in the first line, found {}", file.string(), rows[r].line,
                              names.size(), rows[r].cells.size()));
    Variation v;
    for (size_t c = 0; c < names.size(); c++)
      if (!rows[r].cells[c].empty()) {
        v.values.emplace_back(names[c], rows[r].cells[c]);
        v.origins[names[c]] = {"column " + in_quotes(names[c]), file.string(), rows[r].places[c]};
      }
    out.push_back(std::move(v));
  }
  return out;
}

std::vector<Variation> read_json(const fs::path& file, const std::string& text) {
  const ParsedJson parsed = parse_json(text);
  for (const Problem& p : parsed.problems)
    throw Error(fmt::format("{}:{}:{}: {}", file.string(), p.place.line, p.place.column, p.message));
  const auto refuse = [&](const JsonValue& v) -> Error {
    return Error(
        fmt::format("{}:{}:{}: expected a list of objects such as [{{\"seed\": 1}}, {{\"seed\": 2}}], found {}",
                    file.string(), v.place.line, v.place.column, found(v)));
  };
  if (!parsed.value->is_list() || parsed.value->items.empty()) throw refuse(*parsed.value);
  std::vector<Variation> out;
  size_t cells = 0;
  for (const JsonValue& row : parsed.value->items) {
    if (!row.is_object()) throw refuse(row);
    Variation v;
    if ((cells += row.members.size()) > most_cells) refuse_cells(file);
    for (const JsonMember& m : row.members) {
      v.values.emplace_back(m.name, m.value.is_text() ? m.value.text : compact(m.value));
      v.origins[m.name] = {"member " + in_quotes(m.name), file.string(), m.place};
    }
    out.push_back(std::move(v));
  }
  return out;
}

}  // namespace

std::vector<Variation> read_table(const fs::path& file) {
  const std::string text = read_document(file, "table");
  std::vector<Variation> out =
      file.extension() == ".json" || text.starts_with('[') ? read_json(file, text) : read_csv(file, text);
  if (out.size() > most_variations)
    throw Error(fmt::format("{}: expected at most {} rows, found {}", file.string(), most_variations, out.size()));
  return out;
}

}  // namespace terrazzo
