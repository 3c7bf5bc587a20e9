#include "live/server.h"

#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <list>
#include <map>
#include <thread>
#include <utility>

#include "base/system/thread_priority.h"
#include "live/address.h"
#include "live/gate.h"
#include "live/http_request.h"

namespace pprt {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::asio::ip::tcp;
using boost::beast::error_code;

constexpr std::size_t kMostHeaderBytes = 8192;
constexpr std::size_t kMostQueued = 256;
constexpr int kMostInFlight = 2;

std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

// The page may load nothing and speak to its own server alone. Not all browsers take a WebSocket for 'self'.
std::string security_policy(std::string_view host) {
  constexpr std::string_view kOfAHost = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.:-[]";
  const bool is_plain = host.find_first_not_of(kOfAHost) == std::string_view::npos;
  return "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src blob: data:; "
         "connect-src 'self'" +
         (is_plain ? " ws://" + std::string(host) : "") + "; frame-ancestors 'none'";
}

}  // namespace

class LiveServer::Impl {
 public:
  explicit Impl(LiveServerSettings settings);
  ~Impl();

  const LiveServerSettings& settings() const { return settings_; }
  const std::string& token() const { return token_; }
  std::uint16_t port() const { return port_; }
  asio::io_context& context() { return context_; }

  void start(LiveServerEvents events);
  void show(std::shared_ptr<const LiveFrame> frame);
  void tell_all(const std::string& text);
  void tell(int client, std::string text);
  void send_file(int client, LiveFrame file);

 private:
  class Client;
  class Visit;
  void listen_at(const tcp::endpoint& endpoint);
  void run();
  void accept();
  int join(const std::shared_ptr<Client>& client);
  void leave(int client);
  void make_room_for_stranger();
  bool has_room() const { return clients_.size() < settings_.most_clients; }

  LiveServerSettings settings_;
  LiveServerEvents events_;
  std::string token_ = new_token();
  std::list<Visit*> strangers_;  // connections that have not sent their request, the oldest first
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  std::uint16_t port_ = 0;
  std::map<int, std::shared_ptr<Client>> clients_;
  int last_client_ = 0;
  std::shared_ptr<const LiveFrame> newest_;
  bool is_ending_ = false;
  asio::steady_timer last_moment_{context_};
  std::thread thread_;
};

// One WebSocket.
class LiveServer::Impl::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Impl& server, beast::tcp_stream&& stream) : server_(server), socket_(std::move(stream)) {}

  void run(const http::request<http::empty_body>& request) {
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = nanoseconds(server_.settings_.patience_s);
    timeout.idle_timeout = nanoseconds(server_.settings_.patience_s);
    timeout.keep_alive_pings = true;
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(timeout);
    socket_.read_message_max(server_.settings_.most_message_bytes);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->number_ = self->server_.join(self);
      self->read();
    });
  }

  void show(std::shared_ptr<const LiveFrame> frame) {
    // A picture that has not been sent yet tells more than none.
    if (!frame->image.empty() || !next_frame_) next_frame_ = std::move(frame);
    write();
  }

  void tell(std::string text) { say({.header = std::move(text), .image = {}}, false); }
  void send_file(LiveFrame file) { say(std::move(file), true); }

  // Closes once all texts and files have been sent.
  void end() {
    ends_ = true;
    next_frame_.reset();
    write();
  }

  bool is_closed() const { return closed_; }

  void close() {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    if (number_ > 0) server_.leave(number_);
  }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error || self->closed_) return self->close();
      self->heard();
    });
  }

  void heard() {
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    if (!socket_.got_text()) return close();
    if (text == "ack" && in_flight_ > 0) {
      --in_flight_;
      write();
    } else if (is_too_fast()) {
      return close();
    } else if (text != "ack") {
      server_.events_.said(number_, text);
    }
    if (!closed_) read();
  }

  // Counts the messages of each second.
  bool is_too_fast() {
    const auto now = std::chrono::steady_clock::now();
    if (now - second_began_ > std::chrono::seconds(1)) second_began_ = now, heard_ = 0;
    return ++heard_ > server_.settings_.most_messages_per_second;
  }

  // What must arrive.
  struct QueuedMessage {
    LiveFrame content;
    bool is_file = false;  // else a text: its header
  };

  void say(LiveFrame content, bool is_file) {
    if (queue_.size() >= kMostQueued) return close();
    queue_.push_back({std::move(content), is_file});
    write();
  }

  // Texts go before frames: they are small, and say what a frame is seen with.
  void write() {
    if (writing_ || closed_ || number_ == 0) return;
    if (!queue_.empty()) {
      sent_message_ = std::move(queue_.front());
      queue_.pop_front();
      if (sent_message_.is_file) return write_binary(sent_message_.content);
      socket_.text(true);
      start_write({asio::buffer(sent_message_.content.header), {}, {}});
    } else if (ends_) {
      socket_.async_close(websocket::close_code::going_away,
                          [self = shared_from_this()](error_code) { self->close(); });
      ends_ = false;
    } else if (next_frame_ && in_flight_ < kMostInFlight) {
      frame_ = std::exchange(next_frame_, nullptr);
      ++in_flight_;
      write_binary(*frame_);
    }
  }

  void write_binary(const LiveFrame& frame) {
    constexpr std::string_view kLineBreak = "\n";
    socket_.binary(true);
    start_write({asio::buffer(frame.header), asio::buffer(kLineBreak), asio::buffer(frame.image)});
  }

  using Buffers = std::array<asio::const_buffer, 3>;  // one after the other

  void start_write(const Buffers& message) {
    writing_ = true;
    socket_.async_write(message, [self = shared_from_this()](error_code error, std::size_t) {
      self->writing_ = false;
      if (error) return self->close();
      self->write();
    });
  }

  Impl& server_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  int number_ = 0;  // 0: not joined yet
  bool closed_ = false;
  bool ends_ = false;
  bool writing_ = false;
  std::deque<QueuedMessage> queue_;              // not sent yet
  QueuedMessage sent_message_;                   // being written, or the last one
  std::shared_ptr<const LiveFrame> next_frame_;  // not sent yet
  std::shared_ptr<const LiveFrame> frame_;       // being written, or the last one
  int in_flight_ = 0;                            // frames without an acknowledgement
  std::chrono::steady_clock::time_point second_began_{};
  int heard_ = 0;  // messages in that second
};

// One request: answered and closed, or made a client.
class LiveServer::Impl::Visit : public std::enable_shared_from_this<Visit> {
 public:
  Visit(Impl& server, tcp::socket&& socket) : server_(server), stream_(std::move(socket)) {
    error_code gone;
    address_ = stream_.socket().remote_endpoint(gone).address();
    server_.strangers_.push_back(this);
  }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;
  ~Visit() { server_.strangers_.remove(this); }

  const asio::ip::address& address() const { return address_; }

  void run() {
    parser_.header_limit(kMostHeaderBytes);
    stream_.expires_after(nanoseconds(server_.settings_.request_patience_s));
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) self->answer();
    });
  }

  void close() {
    error_code ignored;
    stream_.socket().close(ignored);
  }

 private:
  void answer() {
    server_.strangers_.remove(this);
    const http::request<http::empty_body>& request = parser_.get();
    switch (admit(gate_request(request), server_.token_, server_.settings_.address)) {
      case GateAnswer::kPage:
        return respond(http::status::ok, server_.settings_.page);
      case GateAnswer::kConnect:
        if (!server_.has_room())
          return respond(http::status::service_unavailable, "Too many are watching.\n");
        return std::make_shared<Client>(server_, std::move(stream_))->run(request);
      case GateAnswer::kForbidden:
        return respond(http::status::forbidden, "This address is not complete, or not from here.\n");
      case GateAnswer::kNotFound:
        return respond(http::status::not_found, "There is nothing here.\n");
      case GateAnswer::kNotAllowed:
        return respond(http::status::method_not_allowed, "Only GET is answered.\n");
      case GateAnswer::kNotUpgraded:
        return respond(http::status::upgrade_required, "This is the page's own connection.\n");
    }
  }

  void respond(http::status status, std::string body) {
    response_.result(status);
    response_.version(11);
    response_.keep_alive(false);
    const bool is_page = status == http::status::ok;
    response_.set(http::field::content_type,
                  is_page ? "text/html; charset=utf-8" : "text/plain; charset=utf-8");
    response_.set(http::field::cache_control, "no-store");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    const beast::string_view host = parser_.get()[http::field::host];
    response_.set("Content-Security-Policy", security_policy({host.data(), host.size()}));
    response_.body() = std::move(body);
    response_.prepare_payload();
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Impl& server_;
  beast::tcp_stream stream_;
  asio::ip::address address_;
  beast::flat_buffer buffer_{kMostHeaderBytes};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

LiveServer::Impl::Impl(LiveServerSettings settings) : settings_(std::move(settings)) {
  const tcp::endpoint endpoint(asio::ip::make_address(settings_.address), settings_.port);
  try {
    listen_at(endpoint);
  } catch (const boost::system::system_error& e) {
    throw std::runtime_error("--live " + settings_.address + ":" + std::to_string(settings_.port) + ": " +
                             e.code().message() + "; port 0 is any that is free");
  }
}

void LiveServer::Impl::listen_at(const tcp::endpoint& endpoint) {
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(asio::socket_base::reuse_address(true));
  acceptor_.bind(endpoint);
  acceptor_.listen();
  port_ = acceptor_.local_endpoint().port();
}

void LiveServer::Impl::start(LiveServerEvents events) {
  events_ = std::move(events);
  accept();
  thread_ = std::thread([this] {
    ask_for_short_waits();
    run();
  });
}

// What one client's message or one frame makes fail must not end the program.
void LiveServer::Impl::run() {
  while (true) {
    try {
      context_.run();
      return;
    } catch (const std::exception& e) {
      if (events_.failed) events_.failed(e.what());
    }
  }
}

LiveServer::Impl::~Impl() {
  if (!thread_.joinable()) return;
  asio::post(context_, [this] {
    is_ending_ = true;
    error_code ignored;
    acceptor_.close(ignored);
    for (const auto& [number, client] : std::map(clients_)) client->end();
    last_moment_.expires_after(std::chrono::milliseconds(500));
    last_moment_.async_wait([this](error_code) { context_.stop(); });
    if (clients_.empty()) last_moment_.cancel();
  });
  thread_.join();
}

void LiveServer::Impl::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!error) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      make_room_for_stranger();
      std::make_shared<Visit>(*this, std::move(socket))->run();
    }
    if (acceptor_.is_open()) accept();
  });
}

void LiveServer::Impl::make_room_for_stranger() {
  if (strangers_.size() < settings_.most_strangers) return;
  std::map<asio::ip::address, int> connections;
  for (const Visit* visit : strangers_) ++connections[visit->address()];
  const auto crowd = std::max_element(connections.begin(), connections.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto oldest = std::find_if(strangers_.begin(), strangers_.end(),
                                   [&](const Visit* visit) { return visit->address() == crowd->first; });
  (*oldest)->close();
  strangers_.erase(oldest);
}

// Nobody may have told it anything before it has joined.
int LiveServer::Impl::join(const std::shared_ptr<Client>& client) {
  const int number = ++last_client_;
  asio::post(context_, [this, number, client] {
    if (client->is_closed()) return;
    clients_.emplace(number, client);
    events_.joined(number);
    if (newest_) client->show(newest_);
  });
  return number;
}

void LiveServer::Impl::leave(int client) {
  asio::post(context_, [this, client] {
    if (clients_.erase(client) > 0) events_.left(client);
    if (is_ending_ && clients_.empty()) last_moment_.cancel();
  });
}

void LiveServer::Impl::show(std::shared_ptr<const LiveFrame> frame) {
  asio::post(context_, [this, frame = std::move(frame)] {
    if (!frame->image.empty() || !newest_) newest_ = frame;
    for (const auto& [number, client] : clients_) client->show(frame);
  });
}

void LiveServer::Impl::tell_all(const std::string& text) {
  asio::post(context_, [this, text] {
    for (const auto& [number, client] : clients_) client->tell(text);
  });
}

void LiveServer::Impl::tell(int client, std::string text) {
  asio::post(context_, [this, client, text = std::move(text)]() mutable {
    if (const auto found = clients_.find(client); found != clients_.end())
      found->second->tell(std::move(text));
  });
}

void LiveServer::Impl::send_file(int client, LiveFrame file) {
  asio::post(context_, [this, client, file = std::move(file)]() mutable {
    if (const auto found = clients_.find(client); found != clients_.end())
      found->second->send_file(std::move(file));
  });
}

LiveServer::LiveServer(LiveServerSettings settings) : impl_(std::make_unique<Impl>(std::move(settings))) {}
LiveServer::~LiveServer() = default;

void LiveServer::start(LiveServerEvents events) {
  impl_->start(std::move(events));
}
std::uint16_t LiveServer::port() const {
  return impl_->port();
}
const std::string& LiveServer::token() const {
  return impl_->token();
}
std::string LiveServer::url() const {
  const std::string& address = impl_->settings().address;
  // No browser goes to the address that stands for all.
  const bool is_any = address == "0.0.0.0" || address == "::";
  return http_address({is_any ? "127.0.0.1" : address, port()}) + token() + "/";
}
void LiveServer::show(std::shared_ptr<const LiveFrame> frame) {
  impl_->show(std::move(frame));
}
void LiveServer::tell_all(std::string text) {
  impl_->tell_all(text);
}
void LiveServer::tell(int client, std::string text) {
  impl_->tell(client, std::move(text));
}
void LiveServer::send_file(int client, LiveFrame file) {
  impl_->send_file(client, std::move(file));
}

}  // namespace pprt
