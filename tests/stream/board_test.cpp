// How ranges become batches.
#include "stream/request_board.h"

#include "base/mailbox.h"
#include "stream/stream_files.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <thread>
#include <utility>

namespace crease {
namespace {

using stream::Batch;
using stream::RequestBoard;

constexpr AsyncOptions kSmall{
    .max_in_flight = 1, .max_gap_bytes = 10, .min_request_bytes = 100, .max_request_bytes = 300};

std::vector<FileRange> spans_of(RequestBoard& board) {
  std::vector<FileRange> spans;
  while (const std::optional<Batch> batch = board.take()) spans.push_back(batch->span);
  return spans;
}

struct Case {
  const char* what;
  std::vector<RangeRequest> asked;
  std::vector<FileRange> spans;  // in the order in which they are taken
};

TEST_CASE("ranges that lie near each other become one request") {
  const Case cases[] = {
      {"one alone", {{{50, 20}}}, {{50, 20}}},
      {"neighbours", {{{0, 20}}, {{20, 30}}}, {{0, 50}}},
      {"a gap that is not too wide", {{{0, 20}}, {{30, 20}}}, {{0, 50}}},
      {"a gap that is too wide", {{{0, 20}}, {{31, 20}}}, {{0, 20}, {31, 20}}},
      {"asked for from back to front", {{{40, 20}}, {{20, 20}}, {{0, 20}}}, {{0, 60}}},
      {"the same twice", {{{5, 20}}, {{5, 20}}}, {{5, 20}}},
      {"one within another", {{{0, 50}}, {{10, 5}}}, {{0, 50}}},
      {"equal priorities: up to the largest request",
       {{{0, 150}}, {{150, 150}}, {{300, 150}}},
       {{0, 300}, {300, 150}}},
      {"a large one is not divided", {{{0, 1000}}}, {{0, 1000}}},
      {"the urgent one first, with what lies near, until it is worth a request",
       {{{0, 40}, 0}, {{40, 40}, 2}, {{80, 40}, 1}},
       {{40, 80}, {0, 40}}},
      {"the first one asked for among equals", {{{500, 20}}, {{0, 20}}}, {{500, 20}, {0, 20}}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.what);
    RequestBoard board("", kSmall);
    board.add(c.asked);
    CHECK(spans_of(board) == c.spans);
  }
}

TEST_CASE("a range that becomes urgent goes first") {
  RequestBoard board("", kSmall);
  const std::vector<RangeRequest> asked = {{{0, 20}}, {{1000, 20}}};
  const Ticket first = board.add(asked);
  board.prioritize(ticket_after(first, 1), 5);
  CHECK(board.take()->span.offset == 1000);
}

TEST_CASE("parts are handed out as soon as their bytes are there") {
  const std::vector<std::byte> file = some_bytes(100);
  RequestBoard board("", kSmall);
  const std::vector<RangeRequest> asked = {{{0, 50}}, {{10, 20}}, {{50, 50}}};
  const Ticket first = board.add(asked);
  Batch batch = *board.take();
  board.deliver(batch, std::span(file).first(30));
  const std::vector<AsyncAnswer> early = board.poll();
  REQUIRE(early.size() == 1);
  CHECK(early[0].ticket == ticket_after(first, 1));
  CHECK(*early[0].bytes == part_of(file, {10, 20}));
  board.deliver(batch, file);
  CHECK(board.poll().size() == 2);
  CHECK(!board.wait(std::chrono::minutes(1)));  // nothing is outstanding, so nothing to wait for
}

TEST_CASE("what was cancelled is not handed out, wherever it is") {
  const std::vector<std::byte> file = some_bytes(100);
  RequestBoard board("", kSmall);
  const std::vector<RangeRequest> asked = {{{0, 50}}, {{50, 50}}, {{500, 50}}};
  const Ticket first = board.add(asked);
  Batch batch = *board.take();
  board.cancel(ticket_after(first, 2));  // waits
  board.cancel(first);                   // in flight
  CHECK(!board.is_abandoned(batch));
  board.deliver(batch, file);
  board.cancel(ticket_after(first, 1));  // has arrived
  CHECK(board.poll().empty());
  CHECK(board.is_abandoned(batch));
  CHECK(!board.has_waiting());
  CHECK(board.statistics().cancelled == 2);
  CHECK(board.statistics().answered == 1);
  board.cancel(first);  // once more is no matter
  CHECK(board.statistics().cancelled == 2);
}

TEST_CASE("what came along with others is there for who asks for it later, once") {
  const std::vector<std::byte> file = some_bytes(200);
  RequestBoard board("", kSmall);
  const std::vector<RangeRequest> asked = {{{0, 20}}, {{30, 20}}, {{50, 30}}};
  const Ticket first = board.add(asked);
  Batch batch = *board.take();
  CHECK(batch.span == FileRange{0, 80});
  board.cancel(ticket_after(first, 2));
  const Ticket gap = board.add(std::vector<RangeRequest>{{{22, 5}}});  // before it has come
  board.deliver(batch, std::span(file).first(40));
  board.deliver(batch, std::span(file).first(80));
  std::vector<AsyncAnswer> answers = board.poll();
  REQUIRE(answers.size() == 3);
  CHECK(answers[1].ticket == gap);
  CHECK(*answers[1].bytes == part_of(file, {22, 5}));
  CHECK(!board.has_waiting());

  // The rest of the gap, the beginning of what was cancelled, and what has no end among it.
  board.add(std::vector<RangeRequest>{{{20, 2}}, {{27, 3}}, {{50, 10}}, {{60, 30}}});
  answers = board.poll();
  REQUIRE(answers.size() == 3);
  CHECK(*answers[0].bytes == part_of(file, {20, 2}));
  CHECK(*answers[1].bytes == part_of(file, {27, 3}));
  CHECK(*answers[2].bytes == part_of(file, {50, 10}));
  CHECK(board.take()->span == FileRange{60, 30});
  board.add(std::vector<RangeRequest>{{{50, 10}}});  // again: as if something was wrong with it
  CHECK(board.poll().empty());
  CHECK(board.has_waiting());
}

TEST_CASE("what is given back answers whoever asks again, or asked meanwhile") {
  const std::vector<std::byte> file = some_bytes(100);
  RequestBoard board("", kSmall);
  board.give_back(10, part_of(file, {10, 50}));
  const Ticket again = board.add(std::vector<RangeRequest>{{{20, 30}}});
  const Ticket meanwhile = board.add(std::vector<RangeRequest>{{{70, 20}}});
  CHECK(board.poll().size() == 1);
  board.give_back(60, part_of(file, {60, 40}));
  const std::vector<AsyncAnswer> answers = board.poll();
  REQUIRE(answers.size() == 1);
  CHECK(answers[0].ticket == meanwhile);
  CHECK(*answers[0].bytes == part_of(file, {70, 20}));
  CHECK(!board.has_waiting());
  board.cancel(again);  // has been polled: no matter
  CHECK(board.statistics().requests == 0);
}

TEST_CASE("bytes that are kept stay below the limit, and are what they were") {
  const std::vector<std::byte> file = some_bytes(3000);
  std::mt19937 random(5);
  stream::KeptBytes kept(400);
  std::vector<char> may_be_there(file.size(), 0);
  for (int round = 0; round < 20'000; ++round) {
    const FileRange range{random() % 2900, random() % 100};
    const std::size_t end = range.offset + range.bytes;
    if (random() % 2 == 0) {
      kept.keep(range.offset, std::span(file).subspan(range.offset, range.bytes));
      std::fill(&may_be_there[range.offset], &may_be_there[end], char(1));
    } else if (const auto bytes = kept.take(range)) {
      CHECK(*bytes == part_of(file, range));
      for (std::size_t i = range.offset; i < end; ++i) CHECK(may_be_there[i] == 1);
      std::fill(&may_be_there[range.offset], &may_be_there[end], char(0));
      if (range.bytes > 0) CHECK(!kept.take(range));
    }
    CHECK(kept.bytes() <= 400);
  }
  CHECK(kept.bytes() > 200);
}

TEST_CASE("the first bytes and the size answer without a request") {
  const std::vector<std::byte> file = some_bytes(100);
  RequestBoard board("a.crease", kSmall);
  const std::vector<RangeRequest> asked = {{{0, 40}}, {{30, 20}}, {{90, 20}}, {{100, 0}}};
  const Ticket first = board.add(asked);
  CHECK(board.poll().empty());
  board.append_prefix(std::span(file).first(45), 100);
  board.set_size(100);
  std::map<Ticket, Result<std::vector<std::byte>>> answers;
  for (AsyncAnswer& answer : board.poll()) answers.emplace(answer.ticket, std::move(answer.bytes));
  REQUIRE(answers.size() == 3);
  CHECK(*answers.at(first) == part_of(file, {0, 40}));
  const Failure beyond = answers.at(ticket_after(first, 2)).failure();
  CHECK(beyond.error == Error::Truncated);
  CHECK(beyond.message == "a.crease: 20 bytes at byte 90 are wanted of 100");
  CHECK(answers.at(ticket_after(first, 3))->empty());
  board.append_prefix(std::span(file).subspan(45), 100);
  const std::vector<AsyncAnswer> rest = board.poll();
  REQUIRE(rest.size() == 1);
  CHECK(*rest[0].bytes == part_of(file, {30, 20}));
  CHECK(board.statistics().requests == 0);
}

TEST_CASE("letters are read once each, those of a thread in its order") {
  constexpr int kThreads = 3, kLetters = 2000;
  Mailbox<std::pair<int, int>> box;  // who, which
  std::vector<std::jthread> writers;
  for (int who = 0; who < kThreads; ++who) {
    writers.emplace_back([&box, who] {
      for (int i = 0; i < kLetters; ++i) box.put({who, i});
    });
  }
  std::array<int, kThreads> next{};
  int read = 0, wrong = 0;
  while (read < kThreads * kLetters) {
    const int before = read;
    box.read([&](const std::pair<int, int>& letter) {
      wrong += next[std::size_t(letter.first)]++ != letter.second;
      ++read;
    });
    if (read == before) std::this_thread::yield();  // there may be fewer processors than threads
  }
  CHECK(wrong == 0);
  box.put({0, 0});  // what nobody reads is freed with the box
}

TEST_CASE("askers and workers meet at a board from several threads, and nothing is lost") {
  const std::vector<std::byte> file = some_bytes(1000);
  RequestBoard board("", kSmall);
  std::vector<std::jthread> workers;
  for (int i = 0; i < 3; ++i) {
    workers.emplace_back([&] {
      while (std::optional<Batch> batch = board.take_or_wait()) {
        board.deliver(*batch, std::span(file).subspan(batch->span.offset, batch->span.bytes));
      }
    });
  }
  std::set<Ticket> open;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const std::vector<RangeRequest> asked = {{{i * 7 % 900, 20}, float(i % 5)},
                                             {{i * 13 % 900, 30}, float(i % 3)}};
    const Ticket first = board.add(asked);
    open.insert({first, ticket_after(first, 1)});
    if (i % 4 == 0) {
      board.cancel(first);
      open.erase(first);
    }
    for (const AsyncAnswer& answer : board.poll()) CHECK(open.erase(answer.ticket) == 1);
  }
  while (board.wait(std::chrono::minutes(1))) {
    for (const AsyncAnswer& answer : board.poll()) CHECK(open.erase(answer.ticket) == 1);
  }
  CHECK(open.empty());
  board.close();
}

}  // namespace
}  // namespace crease
