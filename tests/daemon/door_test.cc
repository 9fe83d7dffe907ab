// Who is let in by the program: tokens, addresses, hosts, origins, the viewer's pages.

#include <sched.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

using Json = nlohmann::json;

constexpr char kToken[] = "correct-horse-battery-staple";
constexpr char kTooOpen[] = "0.0.0.0:0";

/// The program with a folder of pages and, if wanted, a token.
class Door : public ::testing::Test {
 protected:
  Door() {
    std::filesystem::create_directories(folder_ / "viewer/v1");
    folder_.write("viewer/index.html", "<p>hello");
    folder_.write("viewer/v1/status", "a file in the API's way");
    folder_.write("viewer/metrics", "another");
    folder_.write("secret.txt", "secret");
    std::filesystem::create_symlink(folder_ / "secret.txt", folder_ / "viewer/link.txt");
    scene_ = folder_.write("scene.json", kScene);
  }
  std::string token_file(mode_t mode = 0600, const std::string& token = kToken) {
    const auto file = folder_.write("token", token + "\n");
    chmod(file.c_str(), mode);
    return file;
  }
  std::vector<std::string> arguments(const std::string& http,
                                     const std::vector<std::string>& more) {
    std::vector<std::string> all{
        "--config", scene_,   "--data", folder_ / "data", "--lcm",
        "memq://",  "--http", http,     "--viewer",       folder_ / "viewer"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// It ends with status 2 and one line that has all of `words`.
  void refuses(const std::vector<std::string>& call, const std::vector<std::string>& words) {
    DaemonProcess daemon(folder_, {}, call);
    EXPECT_EQ(daemon.wait(), 2);
    const std::string errors = daemon.errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    for (const auto& word : words) EXPECT_NE(errors.find(word), std::string::npos) << errors;
    EXPECT_EQ(errors.find(kToken), std::string::npos);
  }
  static std::string with_token(std::string request, const std::string& token = kToken) {
    return request.insert(request.find("\r\n") + 2, "Authorization: Bearer " + token + "\r\n");
  }

  TestFolder folder_;
  std::string scene_;
};

TEST_F(Door, OffLoopbackOnlyWithAToken) {
  for (const char* http : {kTooOpen, "[::]:0", "192.0.2.1:7780"})
    refuses(arguments(http, {}), {"--token-file", "127.0.0.1"});
  DaemonProcess::Options alone;  // in a network that holds nobody else
  alone.prepare = [] {
    return unshare(CLONE_NEWNET) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0 ? 0 : 77;
  };
  DaemonProcess daemon(folder_, alone, arguments(kTooOpen, {"--token-file", token_file()}));
  const bool ready = eventually([&] {
    return daemon.ended() || daemon.errors().find("ready: http://0.0.0.0:") != std::string::npos;
  });
  if (daemon.ended() && daemon.wait() == 77)
    GTEST_SKIP() << "\n*** NOT TESTED: serving beyond loopback. The kernel allows no network "
                    "namespace here. ***";
  EXPECT_TRUE(ready && !daemon.ended()) << daemon.errors();
}

TEST_F(Door, ATokenFileThatIsNone) {
  refuses(arguments("127.0.0.1:0", {"--token-file", token_file(0640)}),
          {folder_ / "token", "chmod 600"});
  refuses(arguments("127.0.0.1:0", {"--token-file", token_file(0600, "short")}),
          {folder_ / "token", "16 to 256"});
  refuses(arguments("127.0.0.1:0", {"--token-file", folder_ / "none"}), {folder_ / "none"});
  refuses(arguments("127.0.0.1:0", {"--token-file", folder_ / "viewer"}),
          {folder_ / "viewer", "regular"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "data")) << "nothing was begun";
}

TEST_F(Door, EverythingButThePagesNeedsTheToken) {
  DaemonProcess daemon(folder_, {}, arguments("127.0.0.1:0", {"--token-file", token_file()}));
  ASSERT_TRUE(daemon.ready());
  const std::uint16_t port = daemon.port();
  const std::string requests[] = {
      get("/v1/status"),        get("/metrics"),
      get("/v1/openapi.json"),  get("/v1/objects"),
      get("/v1/nothing"),       get("/nothing"),
      get("/v1%2fstatus"),      get("/%76%31/status"),
      get("/link.txt"),         post("/v1/detections", json(frame_number(1))),
      post("/v1/events", "{}"), post("/", "")};
  for (const auto& request : requests) {
    EXPECT_EQ(ask(port, request).status, 401) << request;
    EXPECT_EQ(ask(port, with_token(request, "wrong-horse-battery-staple")).status, 401);
    EXPECT_NE(ask(port, with_token(request)).status, 401) << request;
  }
  EXPECT_EQ(ask(port, get("/")).body, "<p>hello");
  EXPECT_EQ(ask(port, get("/index.html?a=b")).status, 200);
  const auto status = Json::parse(ask(port, with_token(get("/v1/status"))).body);
  EXPECT_EQ(status["frames"]["accepted"], 1) << "the one that had the token";
  EXPECT_EQ(status["http"]["unauthorized"], 2 * std::size(requests));
  const Answer metrics = ask(port, with_token(get("/metrics")));
  EXPECT_NE(metrics.body.find("\nanchord_http_unauthorized_total 24\n"), std::string::npos);
  EXPECT_EQ(daemon.errors().find(kToken), std::string::npos);
}

TEST_F(Door, WithoutATokenOnlyThisMachine) {
  DaemonProcess daemon(folder_, {}, arguments("127.0.0.1:0", {}));
  ASSERT_TRUE(daemon.ready());
  const std::string frame = json(frame_number(1));
  const auto as = [&](const std::string& fields) {
    return ask(daemon.port(), "POST /v1/detections HTTP/1.1\r\n" + fields +
                                  "Content-Type: application/json\r\nContent-Length: " +
                                  std::to_string(frame.size()) + "\r\n\r\n" + frame)
        .status;
  };
  EXPECT_EQ(as("Host: evil.example\r\n"), 421);
  EXPECT_EQ(as("Host: localhost:7780\r\nOrigin: http://evil.example\r\n"), 403);
  EXPECT_EQ(ask(daemon.port(), "GET /v1/objects HTTP/1.1\r\nHost: evil.example\r\n\r\n").status,
            421);
  EXPECT_EQ(counter(daemon.port(), "/http/foreign"), 3);
  EXPECT_EQ(counter(daemon.port(), "/frames/accepted"), 0);
  EXPECT_EQ(as("Host: localhost:7780\r\nOrigin: http://localhost:7780\r\n"), 200);
}

TEST_F(Door, PagesAreNotInTheWayOfTheApi) {
  DaemonProcess daemon(folder_, {}, arguments("127.0.0.1:0", {}));
  ASSERT_TRUE(daemon.ready());
  const auto answer = ask(daemon.port(), get("/"));
  EXPECT_EQ(answer.body, "<p>hello");
  EXPECT_TRUE(answer.has("Content-Type: text/html"));
  EXPECT_TRUE(Json::parse(body(daemon.port(), "/v1/status")).contains("ready"));
  EXPECT_NE(body(daemon.port(), "/metrics").find("anchord_ready"), std::string::npos);
  for (const char* none : {"/link.txt", "/../secret.txt", "/%2e%2e/secret.txt", "/nothing"})
    EXPECT_EQ(ask(daemon.port(), get(none)).status, 404) << none;
  EXPECT_EQ(ask(daemon.port(), post("/", "")).status, 405);
}

TEST_F(Door, NoPagesIfThereIsNoViewer) {
  auto call = arguments("127.0.0.1:0", {});
  call.back() = "";
  DaemonProcess daemon(folder_, {}, call);
  ASSERT_TRUE(daemon.ready());
  EXPECT_EQ(ask(daemon.port(), get("/")).status, 404);
  call.back() = folder_ / "nowhere";
  refuses(call, {folder_ / "nowhere"});
}

}  // namespace
}  // namespace anchord
