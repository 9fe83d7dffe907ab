#include "daemon/installed_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/daemon/scene.h"

namespace anchord {
namespace {

class Installed : public ::testing::Test {
 protected:
  void install(const std::string& prefix) {
    std::filesystem::create_directories(folder_ / (prefix + "/share/anchord/config"));
    folder_.write(prefix + "/share/anchord/config/home.json", "{}");
  }
  InstalledFiles look(const std::string& prefix) {
    return installed_files(folder_ / (prefix + "/bin/anchord"), folder_ / "usr", folder_ / "etc");
  }
  TestFolder folder_;
};

TEST_F(Installed, NothingBesideABuildFolder) {
  EXPECT_EQ(look("build").configuration, "config/home.json");
  EXPECT_EQ(look("build").viewer, "");
  std::filesystem::create_directories(folder_ / "build/bin/viewer");
  EXPECT_EQ(look("build").viewer, folder_ / "build/bin/viewer");
  install("usr");
  const auto elsewhere = installed_files(folder_ / "usr/sbin/anchord", folder_ / "usr", "");
  EXPECT_EQ(elsewhere.configuration, "config/home.json");
}

TEST_F(Installed, TheConfigurationOfItsPrefix) {
  install("opt");
  EXPECT_EQ(look("opt").configuration, folder_ / "opt/share/anchord/config/home.json");
  EXPECT_EQ(look("opt").viewer, "");
  std::filesystem::create_directory(folder_ / "opt/share/anchord/viewer");
  EXPECT_EQ(look("opt").viewer, folder_ / "opt/share/anchord/viewer");
}

TEST_F(Installed, TheMachinesConfigurationForAPackage) {
  install("usr");
  install("opt");
  EXPECT_EQ(look("usr").configuration, folder_ / "usr/share/anchord/config/home.json");
  std::filesystem::create_directories(folder_ / "etc/anchord");
  folder_.write("etc/anchord/home.json", "{}");
  EXPECT_EQ(look("usr").configuration, folder_ / "etc/anchord/home.json");
  EXPECT_EQ(look("opt").configuration, folder_ / "opt/share/anchord/config/home.json");
}

}  // namespace
}  // namespace anchord
