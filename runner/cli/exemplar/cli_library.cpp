#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "core/file/private_folder.h"
#include "core/image_io/image_file.h"
#include "core/picture/contact_sheet.h"
#include "graphs/library/library.h"
#include "graphs/text/problem.h"
#include "nodes/common/registry.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/exemplar/library_making.h"
#include "runner/report/html_report.h"
#include "runner/terminal/console.h"
#include "runner/terminal/limit_flags.h"
#include "runner/terminal/signals.h"
#include "runner/terminal/written_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct LibraryFlags {
  std::string folder, name;
  std::vector<std::string> names, tags;
  std::string summary, sheet;
  LibraryAddition addition;
  bool force = false, json = false;
  LimitFlags limits;

  Library open() const { return folder.empty() ? Library() : Library({fs::absolute(folder).lexically_normal()}); }
};

int add(const LibraryFlags& flags) {
  flags.limits.apply();
  const Library library = flags.open();
  const std::string& name = flags.name;
  as_usage([&] { require_library_name(name); });
  if (!flags.force && library.contains(name))
    throw UsageError(fmt::format("{} is in the library {}; --force replaces it", name, library.folder().string()));
  const PrivateFolder work(library.folder(), "new");  // on the library's file system
  const CancelOnSignal signals;
  RunResult result;
  std::optional<LibraryEntry> entry;
  try {
    LibraryAddition addition = flags.addition;
    entry = made_entry(addition, work.path(), signals.flag(), result);
  } catch (const GraphError& e) {
    std::vector<Problem> problems;
    for (const Problem& p : e.problems())
      problems.push_back({{},
                          p.node == "exemplar" || p.node == "index" ? "SOURCE" : p.where,
                          for_command_line(p.message, flags.addition.source, "--set exemplar.name=")});
    throw GraphError("", std::move(problems));
  }
  for (const Failure& f : result.failures) print_message("error: {}\n", f.message);
  if (!entry) return result.cancelled ? exit_cancelled : exit_failed;
  entry->name = name;
  entry->tags = flags.tags;
  entry->summary = flags.summary;
  library.add(*entry, flags.force);
  print_message("added \"library:{}\" to {}\n", name, library.folder().string());
  return exit_done;
}

/// Whether an entry has all tags, and all words in its name, summary or tags.
bool is_meant(const LibraryEntry& entry, const LibraryFlags& flags) {
  const auto has_tag = [&](const std::string& tag) {
    return std::ranges::any_of(entry.tags, [&](const std::string& t) { return lowercase(t) == lowercase(tag); });
  };
  const std::string text = lowercase(fmt::format("{}\n{}\n{}", entry.name, entry.summary, fmt::join(entry.tags, "\n")));
  return std::ranges::all_of(flags.tags, has_tag) && std::ranges::all_of(flags.names, [&](const std::string& word) {
           return text.find(lowercase(word)) != text.npos;
         });
}

/// The message if no entry matches.
std::string nothing_found(const std::vector<LibraryEntry>& all, const LibraryFlags& flags) {
  if (all.empty()) return "nothing; terrazzo library add makes an entry";
  std::vector<std::string> known;
  for (const LibraryEntry& e : all) known.insert(known.end(), e.tags.begin(), e.tags.end());
  std::string text = "nothing like that";
  for (const std::string& tag : flags.tags)
    if (std::ranges::none_of(known, [&](const std::string& t) { return lowercase(t) == lowercase(tag); }))
      text += fmt::format("; no entry has the tag \"{}\"{}", tag, suggestion(tag, known));
  return text;
}

std::string as_json(const std::vector<LibraryEntry>& entries) {
  Json list = Json::array();
  for (const LibraryEntry& e : entries)
    list.push_back({{"name", e.name},
                    {"summary", e.summary},
                    {"tags", e.tags},
                    {"size", {e.size.width, e.size.height}},
                    {"maps", e.maps},
                    {"analysis", e.analysis.string()},
                    {"content", e.content.hex()},
                    {"picture", e.picture.string()},
                    {"material", e.material.string()},
                    {"settings", e.settings},
                    {"added", e.added}});
  return list.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Table as_table(const std::vector<LibraryEntry>& entries) {
  Table out = {{"name", "size", "tags", "maps", "summary"}};
  for (const LibraryEntry& e : entries)
    out.push_back({e.name, fmt::format("{}x{}", e.size.width, e.size.height), fmt::format("{}", fmt::join(e.tags, " ")),
                   fmt::format("{}", fmt::join(e.maps, " ")), e.summary});
  return out;
}

void write_picture(const Image& image, const fs::path& path) {
  const std::vector<uint8_t> bytes = encoded_file(image, {.format = *format_from(path)});
  write_whole_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void write_sheet(const std::vector<LibraryEntry>& entries, const fs::path& path) {
  constexpr int columns = 6, largest = 8192;
  std::vector<Report::Picture> pictures;
  std::vector<std::vector<ImagePtr>> rows;
  std::vector<std::vector<std::string>> captions;
  const ImageInfo info{.size = {}, .semantic = Semantic::base_color, .color_space = "srgb_texture"};
  for (const LibraryEntry& e : entries) {
    if (e.picture.empty()) continue;
    const ImagePtr picture = read_image(e.picture, info, [](const std::string&) {});
    if (pictures.size() % columns == 0) {
      rows.emplace_back();
      captions.emplace_back();
    }
    rows.back().push_back(picture);
    captions.back().push_back(e.name);
    pictures.push_back({e.name, picture});
  }
  if (is_page(path))
    write_variations_page("Library", as_table(entries), pictures, path);
  else if (pictures.empty())
    throw Error("--sheet: none of these has a picture");
  else
    write_picture(*contact_sheet(rows, largest, captions), path);
  print_message("wrote {}\n", path.string());
}

/// The library's files, which no sheet may overwrite.
std::vector<ProtectedFile> files_of(const std::vector<LibraryEntry>& entries) {
  std::vector<ProtectedFile> out;
  for (const LibraryEntry& e : entries)
    for (const fs::path& path : {e.analysis, e.picture, e.library / (e.name + ".json")})
      out.push_back({path, fmt::format("it belongs to \"library:{}\"", e.name)});
  return out;
}

int list(const LibraryFlags& flags) {
  flags.limits.apply();
  check_sheet(flags.sheet);
  const Library library = flags.open();
  std::vector<std::string> faults;
  std::vector<LibraryEntry> entries = library.entries(faults);
  for (const std::string& fault : faults) print_message("{}{}\n", warning_mark, fault);
  const WrittenFile sheet = {"--sheet", flags.sheet, is_page(flags.sheet) ? WrittenKind::page : WrittenKind::picture};
  check_protected({sheet}, files_of(entries));
  check_replaced({sheet}, flags.force);
  const std::vector<LibraryEntry> all = entries;
  std::erase_if(entries, [&](const LibraryEntry& e) { return !is_meant(e, flags); });
  if (!flags.sheet.empty()) write_sheet(entries, flags.sheet);
  if (flags.json)
    write_result(as_json(entries));
  else if (entries.empty())
    print_message("the library {} holds {}\n", library.folder().string(), nothing_found(all, flags));
  else
    write_result(aligned(as_table(entries)));
  return exit_done;
}

/// Node types whose versions have changed since the analysis.
std::vector<std::string> outdated(const LibraryEntry& entry) {
  std::vector<std::string> out;
  for (const auto& [type, version] : entry.versions)
    if (const NodeType* now = find_node_type(type); now && now->version != version)
      out.push_back(
          fmt::format("version {} of {} made it; version {} makes another analysis", version, type, now->version));
  return out;
}

int check(const LibraryFlags& flags) {
  const Library library = flags.open();
  std::vector<std::string> faults;
  std::vector<LibraryEntry> entries;
  if (flags.names.empty()) entries = library.entries(faults);
  for (const std::string& name : flags.names) entries.push_back(as_usage([&] { return library.find(name); }));
  for (const std::string& fault : faults) print_result("{}\n", fault);
  size_t faulty = faults.size();
  for (const LibraryEntry& e : entries) {
    const std::vector<std::string> found = Library::faults_of(e);
    faulty += !found.empty();
    for (const std::string& fault : found) print_result("{}: {}\n", e.name, fault);
    for (const std::string& old : outdated(e)) print_result("{}: note: {}\n", e.name, old);
  }
  print_result("{}\n", faulty == 0
                           ? fmt::format("{} sound", entries.size() == 1 ? "1 analysis"
                                                                         : fmt::format("{} analyses", entries.size()))
                           : fmt::format("{} of {} with faults", faulty, entries.size() + faults.size()));
  return faulty == 0 ? exit_done : exit_failed;
}

int remove(const LibraryFlags& flags) {
  const Library library = flags.open();
  for (const std::string& name : flags.names) {
    as_usage([&] { library.remove(name); });
    print_message("removed {}\n", name);
  }
  return exit_done;
}

}  // namespace

void add_library_command(Command& program) {
  Command& library = program.add_command("library", "Keeps named analyses, for graphs to share");
  library.footer =
      "Graphs name an analysis as \"library:brick/red\", in load_analysis, and in load_material for its maps.\n"
      "The folder is $TERRAZZO_LIBRARY (several are separated by colons; new analyses go into the first), or\n"
      "terrazzo/library under $XDG_DATA_HOME or ~/.local/share.\n"
      "Examples:\n"
      "  terrazzo library add brick/red bricks/ --tag wall --summary \"old red bricks\"\n"
      "  terrazzo library list --tag wall --sheet walls.html";
  const auto flags = std::make_shared<LibraryFlags>();
  const auto sub = [&](const char* name, const char* help, int (*act)(const LibraryFlags&)) -> Command& {
    Command& command = library.add_command(name, help);
    command.add_option("--library", &flags->folder, "The library's folder, if not the default").takes("DIR");
    command.run = [flags, act] { return act(*flags); };
    return command;
  };

  Command& adding =
      sub("add", "Analyses a folder of maps or a picture, or takes an analysis, and keeps it under a name", add);
  adding.add_option("NAME", &flags->name, "Its name, such as brick/red").required();
  adding
      .add_option("SOURCE", &flags->addition.source, "A folder of maps, a picture, or a file that save_analysis wrote")
      .required()
      .takes("PATH");
  adding.add_option("--material", &flags->addition.material, "For an analysis file: the folder of the analysed maps")
      .takes("DIR");
  adding.add_flag("--other-material", &flags->addition.other_material,
                  "Accept --material even if it does not look like the analysed material");
  adding.add_option("--tag", &flags->tags, "A tag to find it by; may be given several times").takes("TAG").repeated();
  adding.add_option("--summary", &flags->summary, "A line about it").takes("TEXT");
  adding
      .add_option("--set", &flags->addition.set,
                  "Sets a parameter of a node of the stock graph analyse.json, such as "
                  "weighted.weights.height=2; may be given several times")
      .takes("NAME=VALUE")
      .repeated();
  add_limit_flags(adding, flags->limits);
  adding.add_flag("--force", &flags->force, "Replace an existing entry of this name");

  Command& listing = sub("list", "Lists analyses: all, or those with these words in name, summary or tags", list);
  listing.add_option("WORD", &flags->names, "What to look for");
  listing.add_option("--tag", &flags->tags, "Only analyses with this tag; may be given several times")
      .takes("TAG")
      .repeated();
  listing.add_option("--sheet", &flags->sheet, "Write a sheet of their pictures, a picture or a page (.html)")
      .takes("FILE");
  add_limit_flags(listing, flags->limits);
  listing.add_flag("--force", &flags->force, force_help);
  listing.add_flag("--json", &flags->json, "For programs");

  sub("check", "Reads every file and checks that the maps have not changed since the analysis; exit code 1 if one has",
      check)
      .add_option("NAME", &flags->names, "Only these");
  sub("remove", "Removes analyses from the library", remove)
      .add_option("NAME", &flags->names, "Their names")
      .required();
}

}  // namespace terrazzo
