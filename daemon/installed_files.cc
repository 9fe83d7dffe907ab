#include "daemon/installed_files.h"

#include <filesystem>
#include <system_error>

namespace anchord {

namespace fs = std::filesystem;

InstalledFiles installed_files(const std::string& program, const std::string& usr,
                               const std::string& etc) {
  std::error_code ignored;
  const fs::path folder = fs::path(program).parent_path();
  const fs::path share = folder.parent_path() / "share/anchord";
  const auto if_there = [&](const fs::path& viewer) {
    return fs::is_directory(viewer, ignored) ? viewer.string() : "";
  };
  fs::path configuration = share / "config/home.json";
  if (folder.filename() != "bin" || !fs::is_regular_file(configuration, ignored))
    return {"config/home.json", if_there(folder / "viewer")};
  const fs::path of_the_machine = fs::path(etc) / "anchord/home.json";
  if (folder.parent_path() == usr && fs::is_regular_file(of_the_machine, ignored))
    configuration = of_the_machine;
  return {configuration, if_there(share / "viewer")};
}

InstalledFiles installed_files() {
  std::error_code unknown;
  return installed_files(fs::read_symlink("/proc/self/exe", unknown), "/usr", "/etc");
}

}  // namespace anchord
