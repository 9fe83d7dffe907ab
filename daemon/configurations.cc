#include "daemon/configurations.h"

#include <utility>

#include "knowledge/configuration.h"

namespace anchord {

Result<Configurations> Configurations::of(LogReader& log, const World& now) {
  auto logged = log.configurations();
  if (!logged) return logged.error();
  if (logged->empty()) logged->push_back({1, now.background()->knowledge.text});
  return Configurations(*std::move(logged), now);
}

std::size_t Configurations::at(std::int64_t sequence) const {
  std::size_t index = 0;
  while (index + 1 < logged_.size() && logged_[index + 1].first <= sequence) ++index;
  return index;
}

bool Configurations::same_as_now(std::size_t index) const {
  const Knowledge& now = now_.background()->knowledge;
  if (logged_[index].text == now.text) return true;
  const auto then = parse_configuration(logged_[index].text);
  return then.ok() && then.knowledge().fingerprint == now.fingerprint;
}

Result<World> Configurations::empty(std::size_t index) {
  if (const auto known = empty_.find(index); known != empty_.end()) return known->second;
  if (same_as_now(index)) return empty_.emplace(index, now_).first->second;
  const auto then = parse_configuration(logged_[index].text);
  if (!then.ok())
    return invalid("", "the log's configuration from frame " +
                           std::to_string(logged_[index].first) +
                           " on cannot be read by this program: " + then.mistakes().front().text());
  return empty_.emplace(index, World(then.knowledge())).first->second;
}

bool Configurations::made(std::uint64_t fingerprint, std::int64_t sequence) {
  const auto world = empty(at(sequence));
  if (!world) return false;
  const Knowledge& knowledge = world->background()->knowledge;
  return fingerprint == knowledge.fingerprint || fingerprint == knowledge.whole_fingerprint;
}

}  // namespace anchord
