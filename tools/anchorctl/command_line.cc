#include "tools/anchorctl/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "api/bearer_token.h"
#include "tools/anchorctl/event_options.h"
#include "tools/anchorctl/query.h"
#include "tools/anchorctl/read_time.h"
#include "tools/anchorctl/verify_options.h"

namespace anchord {
namespace {

constexpr const char* kDefaultServer = "127.0.0.1:7780";

constexpr const char* kWords =
    " [KEY=VALUE]... [--KEY VALUE]... [--at TIME]\n"
    "An object is such as cup-12, a class such as cup. What else it is like: color=blue,\n"
    "size=small, --place kitchen. Keys and values become parameters of the question.\n"
    "--at asks what was believed then, or what is to be expected: \"yesterday 18:00\",\n"
    "\"2026-11-22 18:00\", \"20 min ago\", now, or microseconds since 1970.\n";

/// Times as people write them become numbers.
Status read_times(Parameters& parameters) {
  for (auto& [name, value] : parameters) {
    if ((name != "at" && name != "from" && name != "to") || (name == "at" && value == "now"))
      continue;
    const auto utime = read_time("--" + name, value, clock_time());
    if (!utime) return utime.error();
    value = std::to_string(*utime);
  }
  return Done{};
}

struct Given {
  std::string server, token_file;
  bool json = false;
  std::optional<unsigned> limit;
  double interval_s = 0.5;
  std::optional<double> for_s;
  VerifyOptions verify;
  EventOptions event;
  RepairCall repair;
  LogCall log;
};

void add_common(CLI::App& app, Given& given) {
  app.add_option(
      "--server", given.server,
      "ADDR:PORT of the daemon; default: ANCHORD_SERVER, else " + std::string(kDefaultServer));
  app.add_option("--token-file", given.token_file,
                 "file with the daemon's token, for its owner alone; default: ANCHORD_TOKEN_FILE");
  app.add_flag("--json", given.json, "print the daemon's JSON as it came");
}

/// `first`: what the bare word may be; empty if the command takes no words.
CLI::App& add_command(CLI::App& app, const std::string& name, const char* what,
                      const std::string& first, Given& given) {
  CLI::App& command = *app.add_subcommand(name, what);
  command.allow_extras();
  if (!first.empty()) command.footer("anchorctl " + name + " " + first + kWords);
  add_common(command, given);
  return command;
}

int wrong(const std::string& what) {
  std::fprintf(stderr, "anchorctl: %s (anchorctl --help tells more)\n", what.c_str());
  return kWrongCall;
}

/// What was given, else what the environment says, else `otherwise`.
std::string given_or(const std::string& given, const char* variable,
                     const std::string& otherwise = {}) {
  if (!given.empty()) return given;
  const char* value = std::getenv(variable);
  return value && *value ? value : otherwise;
}

Result<ServerAddress> server_of(const Given& given) {
  auto server = parse_server(given_or(given.server, "ANCHORD_SERVER", kDefaultServer));
  const std::string file = given_or(given.token_file, "ANCHORD_TOKEN_FILE");
  if (!server || file.empty()) return server;
  const auto token = BearerToken::read(file);
  if (!token) return token.error();
  server->authorization = token->authorization();
  return server;
}

std::variant<Call, int> to_call(const std::string& command, const Given& given,
                                const std::vector<std::string>& words) {
  auto parameters = parse_words(words);
  if (!parameters) return wrong(parameters.error().text());
  if (given.limit) {
    if (find_parameter(*parameters, "limit")) return wrong("limit: is given twice");
    parameters->emplace_back("limit", std::to_string(*given.limit));
  }
  if (command == "status" && !parameters->empty()) {
    return wrong(parameters->front().first + ": status takes no parameters");
  }
  if (command == "watch" && !find_parameter(*parameters, "min_p")) {
    parameters->emplace_back("min_p", "0.5");
  }
  if (Status read = read_times(*parameters); !read) return wrong(read.error().text());
  if (command == "history")  // of an object, also by what people call it
    for (auto& [name, value] : *parameters)
      if (name == "class") name = "object";
  if (command == "watch" && find_parameter(*parameters, "object")) {
    return wrong("object: watch takes a class, a place or other attributes");
  }

  auto server = server_of(given);
  if (!server) return wrong(server.error().text());

  Call call;
  call.command = is_event_command(command) ? "event" : command;
  call.server = *std::move(server);
  call.json = given.json;
  call.interval_s = given.interval_s;
  call.for_s = given.for_s;
  if (command == "verify") {
    auto asked = verify_call(given.verify, *parameters);
    if (!asked) return wrong(asked.error().text());
    call.asked = *std::move(asked);
    call.wait = given.verify.wait;
    call.all = given.verify.all;
  } else if (call.command == "event") {
    auto event = event_body(command, given.event);
    if (!event) return wrong(event.error().text());
    call.event = *std::move(event);
  } else {
    const std::string resource = command == "watch" ? "objects" : command;
    call.asked.target = make_target(resource, *std::move(parameters));
  }
  return call;
}

}  // namespace

std::variant<Call, int> parse_command_line(int argc, const char* const* argv) {
  CLI::App app{"Asks anchord what it believes, and tells it what it cannot see.", "anchorctl"};
  app.footer("For example: anchorctl where cup color=blue size=small\n");
  Given given;
  add_common(app, given);
  app.require_subcommand(1);
  add_command(app, "where", "who may be meant, and where it is", "[OBJECT|CLASS]", given);
  add_command(app, "objects", "every object that fits, or one with its models and alternatives",
              "[OBJECT|CLASS]", given);
  add_command(app, "count", "how many there are, as a distribution", "[CLASS]", given);
  add_command(app, "hypotheses", "the most probable worlds, and in what they differ", "", given)
      .add_option("--limit", given.limit, "that many worlds")
      ->check(CLI::Range(1u, 1'000'000u));
  add_command(app, "history", "where an object was believed to be; --from TIME, --to TIME",
              "OBJECT", given);
  CLI::App& watching = add_command(app, "watch", "shows the objects as they change; Ctrl-C ends it",
                                   "[CLASS]", given);
  watching.add_option("--interval", given.interval_s, "seconds from one look to the next")
      ->check(CLI::Range(0.05, 3600.0))
      ->capture_default_str();
  watching.add_option("--for", given.for_s, "stop after so many seconds")
      ->check(CLI::Range(0.0, 1e9));
  add_options(add_command(app, "verify", "the verification tasks; with an object: look at it",
                          "[OBJECT|CLASS]", given),
              given.verify);
  add_event_commands(app, given.event, [&](CLI::App& command) { add_common(command, given); });
  add_command(app, "status", "how the daemon is", "", given);
  add_repair_command(app, given.repair);
  add_log_commands(app, given.log);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return wrong(error.what());
  }
  const CLI::App& command = *app.get_subcommands().front();
  if (const std::string name = command.get_name();
      name == "repair" || name == "export" || name == "rebuild") {
    Call call;
    call.command = name;
    call.repair = given.repair;
    call.log = given.log;
    return call;
  }
  return to_call(command.get_name(), given, command.remaining());
}

}  // namespace anchord
