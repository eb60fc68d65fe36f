#include <filesystem>
#include <memory>
#include <system_error>

#include <fmt/format.h>

#include "core/file/archive.h"
#include "runner/cli/addon_files.h"
#include "runner/cli/cli_commands.h"
#include "runner/terminal/console.h"
#include "runner/terminal/written_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// The folder in the archive, which is the name of the add-on's Python module.
constexpr std::string_view addon_module = "terrazzo_blender";

struct AddonFlags {
  std::string out;
  bool force = false;
};

int write_addon(const AddonFlags& flags) {
  if (!flags.out.ends_with(".zip"))
    throw UsageError(fmt::format("-o {}: expected a name that ends in .zip, as Blender installs it", flags.out));
  check_replaced({{"-o", flags.out, WrittenKind::zip}}, flags.force);
  const std::unique_ptr<ArchiveWriter> archive = write_archive(flags.out, ArchiveFormat::zip);
  for (const AddonFile& file : addon_files()) archive->add(fmt::format("{}/{}", addon_module, file.name), file.text);
  // So that the add-on finds the program without being told.
  std::error_code unknown;
  archive->add(fmt::format("{}/written_by.txt", addon_module),
               fs::read_symlink("/proc/self/exe", unknown).string() + "\n");
  archive->finish();
  print_message("wrote {}; in Blender: Edit > Preferences > Add-ons > Install\n", flags.out);
  return exit_done;
}

}  // namespace

void add_blender_command(Command& program) {
  Command& command = program.add_command("blender-addon", "Writes the add-on for Blender that fits this program");
  const auto flags = std::make_shared<AddonFlags>();
  command.add_option("-o,--out", &flags->out, "The file to write").required().takes("FILE.zip");
  command.add_flag("--force", &flags->force, force_help);
  command.footer =
      "Blender 3.4 to 4 installs the file under Edit > Preferences > Add-ons. The panel is in the Shader Editor.\n"
      "Example:\n  terrazzo blender-addon -o terrazzo-blender.zip";
  command.run = [flags] { return write_addon(*flags); };
}

}  // namespace terrazzo
