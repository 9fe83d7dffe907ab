#pragma once

#include <string>

namespace anchord {

/// What the daemon takes where the command line says nothing.
struct InstalledFiles {
  std::string configuration;
  std::string viewer;  ///< folder of the pages that are served; empty: there is none
};

/// Looks from where `program` is. As PREFIX/bin/anchord, with PREFIX/share/anchord beside it, it is
/// installed: the viewer is there, and the configuration; of the prefix /usr, which a package is
/// installed in, the configuration is `etc`/anchord/home.json if that exists, which is the
/// machine's to change. Elsewhere, as in a build folder, they are config/home.json, from where it
/// is started, and the folder `viewer` beside it.
InstalledFiles installed_files(const std::string& program, const std::string& usr,
                               const std::string& etc);

/// Of this program.
InstalledFiles installed_files();

}  // namespace anchord
