#include "knowledge/saved_past.h"

#include <cmath>

namespace anchord {
namespace {

using Row = std::span<const StoredValue>;
using Kind = StoredValue::Kind;

std::optional<double> number_in(const StoredValue& value) {
  if (value.kind == Kind::kInteger) return static_cast<double>(value.integer);
  if (value.kind == Kind::kReal && std::isfinite(value.real)) return value.real;
  return {};
}

std::optional<LoggedConfiguration> configuration_in(std::int64_t number, Row row) {
  if (row.size() != 3 || row[0].kind != Kind::kNull || row[1].kind != Kind::kText ||
      row[2].kind != Kind::kInteger)
    return {};
  LoggedConfiguration out{number, std::string(row[1].text())};
  if (row[2].integer != checksum(out)) return {};
  return out;
}

std::optional<LogBase> base_in(std::int64_t number, Row row) {
  if (row.size() != 7 || row[5].kind != Kind::kBytes) return {};
  for (const int i : {1, 2, 3, 4, 6})
    if (row[static_cast<std::size_t>(i)].kind != Kind::kInteger) return {};
  LogBase out;
  out.checkpoint.sequence = number;
  out.first_kept = row[1].integer;
  out.checkpoint.utime = row[2].integer;
  out.checkpoint.frame_checksum = static_cast<std::uint32_t>(row[3].integer);
  out.checkpoint.configuration = static_cast<std::uint64_t>(row[4].integer);
  out.checkpoint.bytes.assign(row[5].bytes.begin(), row[5].bytes.end());
  if (row[6].integer != checksum(out)) return {};
  return out;
}

std::optional<HistorySample> sample_in(Row row) {
  if (row.size() != 9 || row[0].kind != Kind::kNull || row[1].kind != Kind::kText ||
      row[2].kind != Kind::kInteger || (row[4].kind != Kind::kText && row[4].kind != Kind::kNull))
    return {};
  HistorySample out;
  out.object = row[1].text();
  out.utime = row[2].integer;
  out.place = row[4].text();
  double* const numbers[] = {&out.p,           nullptr,          &out.position[0],
                             &out.position[1], &out.position[2], &out.spread};
  for (std::size_t i = 0; i < 6; ++i) {
    if (i == 1) continue;
    const auto number = number_in(row[3 + i]);
    if (!number) return {};
    *numbers[i] = *number;
  }
  if (out.p < 0 || out.p > 1 || out.spread < 0 || out.object.empty()) return {};
  return out;
}

}  // namespace

void SavedPast::take(std::int64_t number, Row row) {
  if (auto configuration = configuration_in(number, row))
    configurations_[number] = std::move(configuration->text);
  else if (auto base = base_in(number, row)) {
    if (!base_ || base_->checkpoint.sequence < number) base_ = std::move(base);
  } else if (auto sample = sample_in(row))
    history_.emplace(std::pair{sample->object, sample->utime}, *sample);
}

std::optional<std::string> SavedPast::change_at(std::int64_t number) {
  auto next = configurations_.upper_bound(number);
  if (next == configurations_.begin()) return {};
  --next;
  if (next->first == told_) return {};
  told_ = next->first;
  return next->second;
}

Status SavedPast::write_history(FrameLog& log, Utime until) const {
  for (const auto& [key, sample] : history_)
    if (sample.utime <= until)
      if (Status put = log.put_sample(sample); !put) return put;
  return Done{};
}

}  // namespace anchord
