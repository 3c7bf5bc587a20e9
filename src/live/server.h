// The live server: one page, and a WebSocket to everybody who looks at it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace pprt {

struct LiveServerSettings {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  // 0: any that is free
  std::string page = {};   // HTML
  std::size_t most_clients = 64;
  std::size_t most_strangers = 16;        // connections that have not said the token yet, besides the clients
  std::size_t most_message_bytes = 4096;  // from a client
  int most_messages_per_second = 300;     // from a client, acknowledgements not counted
  double request_patience_s = 5;          // for a stranger's request and its answer
  double patience_s = 10;                 // for a client that takes in nothing
};

// A picture for all clients: a text before it says what it shows.
struct LiveFrame {
  std::string header;  // JSON, without line breaks
  std::string image;   // JPEG or PNG; empty: the one before is as good
};

// What clients do; called on the server's thread. Clients are numbered from 1 and never again.
struct LiveServerEvents {
  std::function<void(int client)> joined;
  std::function<void(int client, std::string_view text)> said;
  std::function<void(int client)> left;
  std::function<void(std::string_view why)> failed = {};  // something was dropped
};

// Runs on a thread of its own. No client can block a caller, nor any other client.
//
// A client gets the newest frame. It acknowledges each by the text "ack", which said() does not pass on. Two
// frames at most wait for that. Until then newer ones are dropped, for this client alone.
//
// A connection that has said nothing yet cannot keep others out. Where there are too many of these, the one
// that has waited longest is closed, of the address that has most.
//
// Texts and files keep their order. A client that leaves more than 256 of them untaken is closed.
class LiveServer {
 public:
  // Listens when it returns, and answers from start() on. Throws std::runtime_error where the address cannot
  // be had.
  explicit LiveServer(LiveServerSettings settings);
  void start(LiveServerEvents events);

  // Closes all connections, after what is still to be said: half a second at most.
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  std::uint16_t port() const;
  const std::string& token() const;

  // "http://127.0.0.1:4500/TOKEN/"
  std::string url() const;

  // Any thread.
  void show(std::shared_ptr<const LiveFrame> frame);
  void tell_all(std::string text);
  void tell(int client, std::string text);
  void send_file(int client, LiveFrame file);  // of any kind; it is not acknowledged

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pprt
