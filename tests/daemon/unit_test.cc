// The program as its systemd unit runs it, as far as that can be had without systemd: a user of its
// own, nothing to write but its directory, and the system calls that the unit leaves it.

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <fstream>

#include "tests/daemon/daemon_process.h"

namespace anchord {
namespace {

constexpr uid_t kNobody = 65534;

/// What the unit's SystemCallFilter=, RestrictAddressFamilies=, RestrictNamespaces=,
/// RestrictRealtime=, LockPersonality= and MemoryDenyWriteExecute= take away.
std::vector<sock_filter> rules() {
  constexpr auto argument = [](int n) {
    return static_cast<std::uint32_t>(offsetof(seccomp_data, args) + 8 * n);  // little endian
  };
  const auto load = [](std::uint32_t at) {
    return sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at);
  };
  const auto is = [](long value, int yes, int no) {
    return sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(value),
                                static_cast<std::uint8_t>(yes), static_cast<std::uint8_t>(no));
  };
  const sock_filter deny = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
  const sock_filter allow = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  const sock_filter only_exec = BPF_STMT(BPF_ALU | BPF_AND | BPF_K, PROT_EXEC);
  const sock_filter exec_and_write = BPF_STMT(BPF_ALU | BPF_AND | BPF_K, PROT_EXEC | PROT_WRITE);
  std::vector<sock_filter> all{load(offsetof(seccomp_data, nr))};
  for (const long call : {SYS_mount,
                          SYS_umount2,
                          SYS_pivot_root,
                          SYS_chroot,
                          SYS_unshare,
                          SYS_setns,
                          SYS_ptrace,
                          SYS_personality,
                          SYS_reboot,
                          SYS_init_module,
                          SYS_finit_module,
                          SYS_delete_module,
                          SYS_kexec_load,
                          SYS_bpf,
                          SYS_perf_event_open,
                          SYS_acct,
                          SYS_swapon,
                          SYS_swapoff,
                          SYS_settimeofday,
                          SYS_clock_settime,
                          SYS_adjtimex,
                          SYS_sethostname,
                          SYS_setdomainname,
                          SYS_syslog,
                          SYS_quotactl,
                          SYS_fchown,
                          SYS_fchownat,
                          SYS_setuid,
                          SYS_setgid,
                          SYS_setreuid,
                          SYS_setregid,
                          SYS_setresuid,
                          SYS_setresgid,
                          SYS_setgroups,
                          SYS_capset,
                          SYS_add_key,
                          SYS_keyctl,
                          SYS_request_key,
                          SYS_io_setup,
                          SYS_io_uring_setup,
                          SYS_sched_setscheduler,
                          SYS_process_vm_writev,
                          SYS_userfaultfd,
                          SYS_open_by_handle_at})
    all.insert(all.end(), {is(call, 0, 1), deny});
  all.insert(all.end(), {is(SYS_socket, 0, 6), load(argument(0)), is(AF_UNIX, 3, 0),
                         is(AF_INET, 2, 0), is(AF_INET6, 1, 0), deny, allow});
  all.insert(all.end(),
             {is(SYS_mprotect, 0, 5), load(argument(2)), only_exec, is(0, 1, 0), deny, allow});
  all.insert(all.end(), {is(SYS_mmap, 0, 5), load(argument(2)), exec_and_write,
                         is(PROT_EXEC | PROT_WRITE, 0, 1), deny, allow});
  all.push_back(allow);
  return all;
}

/// ProtectSystem=strict: everything is read-only but `folder` and what the kernel shows. False:
/// this kernel does not allow it.
bool protect_system(const std::string& folder) {
  mount_attr read_only{};
  read_only.attr_set = MOUNT_ATTR_RDONLY;
  mount_attr writable{};
  writable.attr_clr = MOUNT_ATTR_RDONLY;
  return unshare(CLONE_NEWNS) == 0 && mount("", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount(folder.c_str(), folder.c_str(), nullptr, MS_BIND, nullptr) == 0 &&
         mount_setattr(AT_FDCWD, "/", AT_RECURSIVE, &read_only, sizeof read_only) == 0 &&
         mount_setattr(AT_FDCWD, "/proc", AT_RECURSIVE, &writable, sizeof writable) == 0 &&
         mount_setattr(AT_FDCWD, folder.c_str(), 0, &writable, sizeof writable) == 0;
}

/// In the child that becomes the daemon.
int confine(const std::string& folder) {
  constexpr int kCannot = 77;
  const rlimit none{0, 0};
  if (geteuid() == 0) {
    if (chown(folder.c_str(), kNobody, kNobody) != 0) return kCannot;
    if (!protect_system(folder)) {
      constexpr char kNote[] = "everything is writable here\n";
      if (write(STDERR_FILENO, kNote, sizeof kNote - 1) < 0) return kCannot;
    }
    if (setgid(kNobody) != 0 || setuid(kNobody) != 0) return kCannot;
  }
  umask(0077);
  setrlimit(RLIMIT_CORE, &none);
  std::vector<sock_filter> filter = rules();
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                 prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0
             ? 0
             : kCannot;
}

/// Where systemd would listen.
class Manager {
 public:
  explicit Manager(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    chmod(path.c_str(), 0777);
  }
  ~Manager() { ::close(socket_); }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  bool hears(const std::string& sign) {
    return eventually([&] {
      char bytes[1024];
      const ssize_t size = ::recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT);
      if (size > 0) told_.append(bytes, static_cast<std::size_t>(size)).append("\n");
      return told_.find(sign) != std::string::npos;
    });
  }

 private:
  int socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::string told_;
};

TEST(Unit, TheDaemonLivesWithWhatItLeaves) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "\n*** NOT TESTED: sanitizers need what the unit takes away. ***";
#endif
  TestFolder folder;
  Manager manager(folder / "notify");
  DaemonProcess::Options options;
  options.environment = {"NOTIFY_SOCKET=" + (folder / "notify")};
  const std::string path = folder / "";
  options.prepare = [&] { return confine(path); };
  DaemonProcess daemon(folder, options);
  if (eventually([&] { return daemon.ended() || manager.hears("READY=1\n"); }) && daemon.ended() &&
      daemon.wait() == 77)
    GTEST_SKIP() << "\n*** NOT TESTED: the daemon as its unit runs it. The kernel allows no "
                    "seccomp filters here. ***";
  ASSERT_TRUE(daemon.ready());
  EXPECT_TRUE(manager.hears("WATCHDOG=1\n"));
  EXPECT_EQ(ask(daemon.port(), post("/v1/detections", json(frame_number(1)))).status, 200);
  EXPECT_EQ(counter(daemon.port(), "/log/frames"), 1);

  // The process that receives LCM is started, and started again, and is the first to go.
  const auto child = [&] {
    pid_t found = 0;
    const std::string tasks = "/proc/" + std::to_string(daemon.pid()) + "/task";
    for (const auto& task : std::filesystem::directory_iterator(tasks))
      std::ifstream(task.path() / "children") >> found;
    return found;
  };
  ASSERT_NE(child(), 0);
  kill(child(), SIGKILL);
  EXPECT_TRUE(eventually([&] {
    return counter(daemon.port(), "/lcm/restarts") == 1 &&
           body(daemon.port(), "/v1/status").find("\"receiving\":true") != std::string::npos;
  }));
  int score = 0;
  std::ifstream("/proc/" + std::to_string(child()) + "/oom_score_adj") >> score;
  EXPECT_EQ(score, 1000);
  struct stat found {};
  ASSERT_EQ(stat((folder / "data/anchord.db").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0600u);
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  EXPECT_TRUE(manager.hears("STOPPING=1\n"));
}

}  // namespace
}  // namespace anchord
