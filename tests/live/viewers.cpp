// Viewers of a live picture without a screen: viewers URL SECONDS VIEWERS [STALLED] [steer].
//
// Each acknowledges the frames that it gets. STALLED of them take in nothing after they have connected. With
// "steer" the first viewer takes the camera and moves it at odd moments.
//
// Prints one line of what the first viewer saw. It begins with three counts: frames made, frames on time,
// pictures that came. With "steer" three lags follow: the median, the 90th percentile and the longest. A lag
// is the time from a camera until a picture shows it or a later one, in periods of the frame rate.
#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <deque>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using Json = nlohmann::json;
using asio::ip::tcp;

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

struct Address {
  std::string host, port, path;
};

Address parse(const std::string& url) {
  std::smatch m;
  if (!std::regex_match(url, m, std::regex("http://([^:/]+):(\\d+)(/.*/)")))
    throw std::runtime_error("no URL: " + url);
  return {m[1], m[2], m[3]};
}

using Socket = websocket::stream<tcp::socket>;

std::unique_ptr<Socket> connect(asio::io_context& context, const Address& address) {
  auto socket = std::make_unique<Socket>(context);
  asio::connect(socket->next_layer(), tcp::resolver(context).resolve(address.host, address.port));
  socket->next_layer().set_option(tcp::no_delay(true));
  socket->handshake(address.host + ":" + address.port, address.path + "socket");
  return socket;
}

// What the first viewer measures.
struct Figures {
  int frames = 0, on_time = 0, pictures = 0;
  double period_ms = 0;
  std::vector<double> lags_ms;
};

// By nearest rank; 0 without values.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

// Takes in what comes, and steers, until `end_ms`.
class Watcher {
 public:
  Watcher(const Address& address, bool steers) : socket_(connect(context_, address)), steers_(steers) {}

  Figures watch(double end_ms) {
    read();
    if (steers_) write(R"({"do":"take"})");
    move_later();
    context_.run_for(std::chrono::milliseconds(static_cast<int>(end_ms - now_ms())));
    return figures_;
  }

 private:
  void read() {
    socket_->async_read(buffer_, [this](beast::error_code error, std::size_t) {
      if (error) return;
      take_in();
      read();
    });
  }

  void take_in() {
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    if (socket_->got_text()) {
      const Json message = Json::parse(text);
      if (message.contains("state")) figures_.period_ms = 1000 / message["state"]["rate"].get<double>();
      if (message.contains("hello")) home_ = message["hello"]["home"];
      return;
    }
    write("ack");
    const Json header = Json::parse(text.substr(0, text.find('\n')));
    for (const Json& frame : header["frames"]) {
      ++figures_.frames;
      figures_.on_time += frame["slack_ms"].get<double>() >= 0;
    }
    if (header["type"].get<std::string>().empty()) return;
    ++figures_.pictures;
    const unsigned look = header["look"].get<unsigned>();
    while (!sent_.empty() && sent_.front().first <= look) {
      figures_.lags_ms.push_back(now_ms() - sent_.front().second);
      sent_.pop_front();
    }
  }

  // A camera every 5 to 40 ms, on a circle round what the scene's own looks at.
  void move_later() {
    timer_.expires_after(std::chrono::microseconds(std::uniform_int_distribution(5000, 40000)(random_)));
    timer_.async_wait([this](beast::error_code error) {
      if (error || !steers_) return;
      if (!home_.is_null()) move();
      move_later();
    });
  }

  void move() {
    turn_ += 0.01;
    Json look = home_;
    const double x = home_["from"][0].get<double>() - home_["at"][0].get<double>();
    const double y = home_["from"][1].get<double>() - home_["at"][1].get<double>();
    look["from"][0] = home_["at"][0].get<double>() + x * std::cos(turn_) - y * std::sin(turn_);
    look["from"][1] = home_["at"][1].get<double>() + x * std::sin(turn_) + y * std::cos(turn_);
    look["do"] = "look";
    look["number"] = ++look_;
    sent_.emplace_back(look_, now_ms());
    write(look.dump());
  }

  void write(std::string text) {
    waiting_.push_back(std::move(text));
    if (waiting_.size() == 1) write_next();
  }
  void write_next() {
    socket_->text(true);
    socket_->async_write(asio::buffer(waiting_.front()), [this](beast::error_code error, std::size_t) {
      waiting_.pop_front();
      if (!error && !waiting_.empty()) write_next();
    });
  }

  asio::io_context context_;
  std::unique_ptr<Socket> socket_;
  bool steers_;
  beast::flat_buffer buffer_;
  asio::steady_timer timer_{context_};
  std::deque<std::string> waiting_;
  std::deque<std::pair<unsigned, double>> sent_;  // cameras that no picture has shown
  std::mt19937 random_{1};
  Json home_;
  double turn_ = 0;
  unsigned look_ = 0;
  Figures figures_;
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) throw std::runtime_error("want URL SECONDS VIEWERS [STALLED] [steer]");
  const Address address = parse(argv[1]);
  const double end_ms = now_ms() + 1000 * std::stod(argv[2]);
  const int viewers = std::stoi(argv[3]), stalled = argc > 4 ? std::stoi(argv[4]) : 0;
  const bool steers = argc > 5;
  asio::io_context context;
  std::vector<std::unique_ptr<Socket>> asleep;
  for (int i = 0; i < stalled; ++i) asleep.push_back(connect(context, address));
  std::vector<std::thread> others;
  for (int i = 1; i < viewers - stalled; ++i) {
    others.emplace_back([&] { Watcher(address, false).watch(end_ms); });
  }
  const Figures figures = Watcher(address, steers).watch(end_ms);
  for (std::thread& other : others) other.join();
  std::cout << figures.frames << " " << figures.on_time << " " << figures.pictures;
  if (steers) {
    for (const double share : {0.5, 0.9, 1.0})
      std::cout << " " << percentile(figures.lags_ms, share) / figures.period_ms;
  }
  std::cout << "\n";
  return 0;
} catch (const std::exception& e) {
  std::cerr << "viewers: " << e.what() << "\n";
  return 1;
}
