#include "tests/daemon/daemon_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

namespace anchord {

bool eventually(const std::function<bool()>& condition) {
  const auto give_up = std::chrono::steady_clock::now() + milliseconds(kPatienceMs);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(milliseconds(2));
  }
  return true;
}

DaemonProcess::DaemonProcess(const TestFolder& folder, Options options,
                             std::vector<std::string> arguments) {
  static std::atomic<int> number{0};
  errors_file_ = folder / ("errors-" + std::to_string(++number));
  if (arguments.empty())
    arguments = {"--config", folder.write("scene.json", options.scene),
                 "--data",   folder / options.data,
                 "--lcm",    options.lcm,
                 "--http",   options.http};
  if (!options.checkpoint_interval.empty())
    arguments.insert(arguments.end(), {"--checkpoint-interval", options.checkpoint_interval});
  arguments.insert(arguments.begin(), ANCHORD);
  std::vector<char*> argv, environment;
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  for (char** entry = environ; *entry; ++entry) environment.push_back(*entry);
  for (auto& entry : options.environment) environment.push_back(entry.data());
  environment.push_back(nullptr);
  const int errors = ::open(errors_file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);

  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(errors, STDERR_FILENO);
    if (const int refused = options.prepare ? options.prepare() : 0) _exit(refused);
    execve(ANCHORD, argv.data(), environment.data());
    _exit(127);
  }
  ::close(errors);
}

DaemonProcess::~DaemonProcess() { end(SIGKILL); }

bool DaemonProcess::ended() {
  int status = 0;
  if (!ended_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    ended_ = true;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  return ended_;
}

bool DaemonProcess::ready() {
  const std::string sign = "ready: http://127.0.0.1:";
  const bool told = eventually([&] {
    const std::string text = errors();
    const auto at = text.find(sign);
    if (at == std::string::npos || text.find('\n', at) == std::string::npos) return ended();
    port_ = static_cast<std::uint16_t>(std::stoi(text.substr(at + sign.size())));
    return true;
  });
  EXPECT_TRUE(told && port_ != 0) << errors();
  return port_ != 0;
}

std::string DaemonProcess::errors() const {
  std::ifstream file(errors_file_);
  return {std::istreambuf_iterator<char>(file), {}};
}

int DaemonProcess::end(int signal) {
  if (ended()) return status_;
  kill(pid_, signal);
  return wait();
}

int DaemonProcess::wait() {
  EXPECT_TRUE(eventually([this] { return ended(); })) << "it does not end";
  return status_;
}

Answer ask(std::uint16_t port, const std::string& request) { return Client(port).ask(request); }

std::string body(std::uint16_t port, const std::string& target) {
  const Answer answer = ask(port, get(target));
  EXPECT_EQ(answer.status, 200) << target << ": " << answer.body;
  return answer.body;
}

std::string belief(std::uint16_t port) {
  return body(port, "/v1/objects?min_p=0") + body(port, "/v1/hypotheses") + body(port, "/v1/count");
}

std::int64_t counter(std::uint16_t port, const std::string& pointer) {
  return nlohmann::json::parse(body(port, "/v1/status"))
      .at(nlohmann::json::json_pointer(pointer))
      .get<std::int64_t>();
}

}  // namespace anchord
