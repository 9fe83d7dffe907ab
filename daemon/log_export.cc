#include "daemon/log_export.h"

#include <algorithm>
#include <optional>

#include "anchoring/checkpoint.h"
#include "api/logged.h"
#include "daemon/past.h"
#include "knowledge/configuration.h"

namespace anchord {
namespace {

/// The state of a world, with the frames that it names.
Result<ReplayNote> state_note(const World& world, LogReader& log) {
  const WorldState state = world.state();
  ReplayNote note;
  note.state.emplace();
  note.state->checkpoint = write_checkpoint(state, *world.background());
  for (const WorldState::Step& step : state.recent) {
    const auto logged = log.at(step.number);
    if (!logged) return logged.error();
    if (!*logged) return Error{ErrorCode::kUnknown, "from", "lies before what the log still holds"};
    auto accepted = read_logged(**logged);
    if (!accepted) return accepted.error();
    note.state->recent.push_back(*std::move(accepted));
  }
  return note;
}

}  // namespace

Result<ExportReport> export_log(const std::string& directory, Utime from, Utime to,
                                const std::function<Status(const ExportedItem&)>& give) {
  auto log = LogReader::open(directory);
  if (!log) return log.error();
  const auto configurations = log->configurations();
  if (!configurations) return configurations.error();
  if (configurations->empty())
    return Error{ErrorCode::kUnknown, "",
                 "the log says nothing of its configuration: it is of an older program; let this "
                 "one take a frame first"};
  const auto first = parse_configuration(configurations->front().text);
  if (!first.ok()) return invalid("", first.mistakes().front().text());

  // The belief just before the span.
  Past past(directory, World(first.knowledge()));
  const auto before = past.world_at(std::max(from - 1, Utime{0}), 0);
  if (!before) return before.error();
  ReplayNote begin;
  begin.configuration = before->world.background()->knowledge.text;
  if (Status given = give(begin); !given) return given.error();
  if (before->world.belief()->frames > 0) {
    const auto state = state_note(before->world, *log);
    if (!state) return state.error();
    if (Status given = give(*state); !given) return given.error();
  }

  ExportReport report;
  std::int64_t expected = before->world.state().taken + 1;
  std::string in_force = begin.configuration;
  double lateness = before->world.background()->knowledge.max_lateness;
  Utime newest = before->world.belief()->utime;
  Status given = Done{};
  const Status read = log->for_each(before->next, [&](const LoggedFrame& logged) {
    // As Past has it.
    const bool event = logged.kind == LoggedFrame::Kind::kEvent;
    const bool of_another_clock =
        event && newest > 0 && logged.utime - newest > from_seconds(lateness);
    const Utime order = of_another_clock ? newest : logged.utime;
    if (!event) newest = std::max(newest, logged.utime);
    if (order < from || order > to) return newest - from_seconds(lateness) <= to;
    const auto accepted = read_logged(logged);
    if (!accepted) return (given = accepted.error()), false;
    ReplayNote note;
    for (const LoggedConfiguration& one : *configurations)
      if (one.first <= logged.sequence && one.first > before->next - 1)
        note.configuration = one.text;
    if (note.configuration == in_force) note.configuration.clear();
    if (!note.configuration.empty()) {
      in_force = note.configuration;
      if (const auto changed = parse_configuration(in_force); changed.ok())
        lateness = changed.knowledge().max_lateness;
    }
    if (logged.sequence != expected) note.number = logged.sequence;
    note.work = accepted->work;
    expected = logged.sequence + 1;
    if (!note.configuration.empty() || note.number || note.work) given = give(note);
    if (!given) return false;
    if (event) {
      ++report.events;
      given = give(std::get<Event>(accepted->what));
    } else {
      ++report.frames;
      given = give(std::get<Frame>(accepted->what));
    }
    return given.ok() && newest - from_seconds(lateness) <= to;
  });
  if (!read) return read.error();
  if (!given) return given.error();
  return report;
}

}  // namespace anchord
