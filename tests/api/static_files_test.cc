#include "api/static_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/api/http_client.h"
#include "tests/daemon/scene.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;

/// A folder `viewer` with two pages, and a secret beside it.
class Viewer : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "viewer/parts/deep");
    folder_.write("secret.txt", "secret");
    fs::create_directory(folder_ / "outside");
    folder_.write("outside/secret.txt", "secret");
    folder_.write("viewer/index.html", "<p>hello");
    folder_.write("viewer/parts/app.js", "let a = 1;");
    folder_.write("viewer/parts/index.html", "<p>parts");
  }
  StaticFiles read() {
    auto files = StaticFiles::read(folder_ / "viewer");
    EXPECT_TRUE(files.ok()) << files.error().text();
    return files ? *std::move(files) : StaticFiles();
  }
  TestFolder folder_;
};

TEST_F(Viewer, ServesFilesByTheirNames) {
  const StaticFiles files = read();
  EXPECT_EQ(files.size(), 3u);
  const auto page = files.answer("/", "");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->content_type, "text/html; charset=utf-8");
  EXPECT_EQ(page->body, "<p>hello");
  EXPECT_EQ(files.answer("/index.html", "")->body, "<p>hello");
  EXPECT_EQ(files.answer("/parts/", "")->body, "<p>parts");
  EXPECT_EQ(files.answer("/parts/app.js", "")->content_type, "text/javascript; charset=utf-8");
  for (const char* other : {"", "/parts", "index.html", "/nothing", "/INDEX.HTML", "//index.html",
                            "/parts//app.js", "/./index.html", "/index.html/", "/*"})
    EXPECT_FALSE(files.answer(other, "")) << other;
}

TEST_F(Viewer, LeavesOutLinksAndWhatIsHidden) {
  fs::create_symlink(folder_ / "secret.txt", folder_ / "viewer/link.txt");
  fs::create_symlink(folder_ / "outside", folder_ / "viewer/linked");
  fs::create_symlink("index.html", folder_ / "viewer/inside.html");
  fs::create_symlink("/etc/passwd", folder_ / "viewer/parts/passwd.txt");
  fs::create_symlink("nowhere", folder_ / "viewer/broken.html");
  folder_.write("viewer/.htpasswd", "secret");
  fs::create_directory(folder_ / "viewer/.git");
  folder_.write("viewer/.git/config", "secret");
  folder_.write("viewer/a b.html", "");
  ASSERT_EQ(mkfifo((folder_ / "viewer/fifo").c_str(), 0600), 0);
  EXPECT_EQ(read().size(), 3u);
}

TEST_F(Viewer, MayItselfBeReachedByALink) {
  fs::create_directory_symlink(folder_ / "viewer", folder_ / "link");
  const auto files = StaticFiles::read(folder_ / "link");
  ASSERT_TRUE(files.ok());
  EXPECT_EQ(files->size(), 3u);
}

TEST_F(Viewer, IsReadOnce) {
  const StaticFiles files = read();
  folder_.write("viewer/index.html", "changed");
  folder_.write("viewer/new.html", "new");
  EXPECT_EQ(files.answer("/", "")->body, "<p>hello");
  EXPECT_FALSE(files.has("/new.html"));
}

TEST_F(Viewer, IsNotSentAgainToWhoHasIt) {
  const StaticFiles files = read();
  const auto page = files.answer("/", "");
  std::string tag;
  for (const auto& [name, value] : page->headers)
    if (name == "ETag") tag = value;
  ASSERT_GT(tag.size(), 2u);
  EXPECT_EQ(files.answer("/", tag)->status, 304);
  EXPECT_EQ(files.answer("/", "\"other\", W/" + tag)->status, 304);
  EXPECT_EQ(files.answer("/", "*")->status, 304);
  EXPECT_EQ(files.answer("/", tag)->body, "");
  EXPECT_EQ(files.answer("/parts/app.js", tag)->status, 200) << "another file's";
  folder_.write("viewer/index.html", "<p>hellp");
  EXPECT_EQ(read().answer("/", tag)->status, 200) << "another content";
}

TEST_F(Viewer, IsRefusedOverItsLimits) {
  EXPECT_EQ(StaticFiles::read(folder_ / "none").error().field, folder_ / "none");
  EXPECT_FALSE(StaticFiles::read(folder_ / "secret.txt").ok());
  folder_.write("viewer/large", std::string(StaticFiles::kMostBytes, 'x'));
  const auto large = StaticFiles::read(folder_ / "viewer");
  ASSERT_FALSE(large.ok());
  EXPECT_EQ(large.error().code, ErrorCode::kInvalid);
  EXPECT_NE(large.error().message.find("bytes"), std::string::npos);
  fs::remove(folder_ / "viewer/large");
  for (std::size_t i = 0; i < StaticFiles::kMostFiles; ++i)
    folder_.write("viewer/" + std::to_string(i), "");
  const auto many = StaticFiles::read(folder_ / "viewer");
  ASSERT_FALSE(many.ok());
  EXPECT_NE(many.error().message.find("1024 files"), std::string::npos);
}

TEST_F(Viewer, NoRequestReadsWhatIsOutside) {
  auto server = serve([files = read()](HttpRequest request, HttpReply reply) {
    auto answer = files.answer(request.target.path, request.if_none_match);
    reply(answer ? *std::move(answer) : http_error(404, "unknown", "no such file"));
  });
  const auto ask = [&](const std::string& target) {
    return Client(server->port()).ask(get(target));
  };
  EXPECT_EQ(ask("/").status, 200);
  EXPECT_TRUE(ask("/").has("Content-Security-Policy: default-src 'self'"));
  EXPECT_TRUE(ask("/").has("X-Content-Type-Options: nosniff\r\n"));
  EXPECT_EQ(ask("/parts/%61pp.js?v=1").status, 200);
  for (const std::string& target :
       {std::string("/../secret.txt"), std::string("/parts/../../secret.txt"),
        std::string("/%2e%2e/secret.txt"), std::string("/%2e%2e%2fsecret.txt"),
        std::string("/..%5csecret.txt"), std::string("/%252e%252e/secret.txt"),
        std::string("/index.html%00.txt"), std::string("/%00"), folder_ / "secret.txt",
        "/" + (folder_ / "secret.txt"), "//" + (folder_ / "secret.txt"), std::string("/etc/passwd"),
        std::string("//etc/passwd"), std::string("file:///etc/passwd"),
        std::string("http://x/../secret.txt"), std::string("/parts/%c0%ae%c0%ae/secret.txt"),
        std::string("../secret.txt"), std::string("secret.txt")}) {
    const Answer answer = ask(target);
    EXPECT_TRUE(answer.status == 404 || answer.status == 400) << target << answer.status;
    EXPECT_EQ(answer.body.find("root:"), std::string::npos);
  }
}

}  // namespace
}  // namespace anchord
