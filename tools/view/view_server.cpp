// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/view/view_server.hpp"

#include <libwebsockets.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <list>
#include <map>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "tools/view/feed/frame_queue.hpp"

namespace tread::view {
namespace {

using Json = nlohmann::json;

// What viewers may cost. One that wants more waits, gets the newest only, or is closed.
constexpr size_t kMostClients = 32;
constexpr size_t kMostPages = 40;      // clients and, beside them, pages of our own
constexpr double kAcceptRate = 100.0;  // [1/s] new connections
constexpr double kAcceptBurst = 200.0;
constexpr size_t kLargestRequest = 1 << 16;  // [bytes] of a client
constexpr double kRequestRate = 32'000.0;    // [bytes/s] of a client
constexpr double kRequestBurst = 128'000.0;  // [bytes]
constexpr size_t kLeastRequest = 200;        // [bytes] that each request counts at least
constexpr size_t kMostTopics = 16;           // of a client's own
constexpr size_t kLongestTopic = 64;         // [bytes]
constexpr double kSendRate = 12e6;           // [bytes/s] to all but who operates the robot
constexpr double kSendBurst = 1e6;           // [bytes]
constexpr size_t kPiece = 65'536;            // [bytes] for a client in its turn
constexpr double kLongestStep = 0.01;        // [s] that a step counts for all this
constexpr size_t kReceiveBuffer = 4096;      // [bytes]
constexpr size_t kHttpPiece = 16384;         // [bytes]

// No channels have these numbers: a text for one client, and what is newest for all.
constexpr uint32_t kText = UINT32_MAX;
constexpr uint32_t kTime = UINT32_MAX - 1;
constexpr uint32_t kWords = UINT32_MAX - 2;

constexpr const char* kCommandTopic = "view/command";
constexpr const char* kControlTopic = "view/control";

std::string headerOf(lws* socket, lws_token_indexes token) {
  std::string text(static_cast<size_t>(lws_hdr_total_length(socket, token)) + 1, '\0');
  const int size = lws_hdr_copy(socket, text.data(), static_cast<int>(text.size()), token);
  text.resize(static_cast<size_t>(std::max(0, size)));
  return text;
}

/// The value of an argument of the address: "?token=..."
std::string argumentOf(lws* socket, const char* name) {
  char buffer[256] = {};
  const char* const value =
      lws_get_urlarg_by_name(socket, (std::string(name) + "=").c_str(), buffer, sizeof buffer);
  return value != nullptr ? value : "";
}

int addHeader(lws* socket, const char* name, const std::string& value, unsigned char** at,
              unsigned char* end) {
  return lws_add_http_header_by_name(socket, reinterpret_cast<const unsigned char*>(name),
                                     reinterpret_cast<const unsigned char*>(value.data()),
                                     static_cast<int>(value.size()), at, end);
}

Visitor visitorOf(lws* socket) {
  return {headerOf(socket, WSI_TOKEN_HOST), headerOf(socket, WSI_TOKEN_ORIGIN),
          argumentOf(socket, "token")};
}

}  // namespace

/// One WebSocket of a viewer.
struct ViewServer::Client {
  lws* socket = nullptr;
  uint64_t number = 0;
  bool may_command = false;
  bool asked = false;                          ///< libwebsockets says when the line takes more
  std::map<uint32_t, uint32_t> subscriptions;  ///< by channel
  std::map<uint32_t, std::string> topics;      ///< its own channels
  FrameQueue frames;
  std::string received;
  Allowance requests{kRequestRate, kRequestBurst};

  /// One that is behind has other worries.
  void pushText(std::string text) {
    if (!frames.isCrowded())
      frames.push({{kText, 0}, 0, std::make_shared<const std::string>(std::move(text)), false});
  }
};

/// What libwebsockets calls back.
struct ViewServer::Sockets {
  explicit Sockets(ViewServer& owner) : server(owner) {}

  static int called(lws* socket, lws_callback_reasons reason, void* user, void* in, size_t size) {
    auto* const sockets = static_cast<Sockets*>(lws_context_user(lws_get_context(socket)));
    // Nothing may be thrown through C.
    try {
      return sockets == nullptr ? 0 : sockets->handle(socket, reason, user, in, size);
    } catch (const std::exception&) {
      return -1;
    }
  }

  int handle(lws* socket, lws_callback_reasons reason, void* user, void* in, size_t size) {
    switch (reason) {
      case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:
        return accepts.take() ? 0 : -1;
      case LWS_CALLBACK_HTTP:
        return http(socket, static_cast<size_t*>(user));
      case LWS_CALLBACK_HTTP_WRITEABLE:
        return httpBody(socket, static_cast<size_t*>(user));
      case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return allowed(socket) && hasRoom(socket) ? 0 : -1;
      case LWS_CALLBACK_ESTABLISHED:
        open(socket);
        return 0;
      case LWS_CALLBACK_CLOSED:
        close(socket);
        return 0;
      case LWS_CALLBACK_RECEIVE:
        return receive(socket, in, size);
      case LWS_CALLBACK_SERVER_WRITEABLE:
        return write(socket);
      default:
        return 0;
    }
  }

  bool allowed(lws* socket) const { return mayLook(visitorOf(socket), server.settings_); }

  /// Programs that fill all places must not keep the operator's page out.
  bool hasRoom(lws* socket) const {
    const Visitor visitor = visitorOf(socket);
    const bool page = isOurs(visitor, server.settings_) && !visitor.origin.empty();
    return clients.size() < (page ? kMostPages : kMostClients);
  }

  int http(lws* socket, size_t* sent) const {
    const bool ours = allowed(socket);
    const std::string path = headerOf(socket, WSI_TOKEN_GET_URI);
    if (!ours ||
        (path != "/" && path != "/index.html" && server.settings_.paths.count(path) == 0)) {
      lws_return_http_status(socket, ours ? HTTP_STATUS_NOT_FOUND : HTTP_STATUS_FORBIDDEN,
                             ours ? "only the page is here"
                                  : "the address must end with ?token=..., as tread-view said");
      return lws_http_transaction_completed(socket) != 0 ? -1 : 0;
    }
    unsigned char head[LWS_PRE + 1024];
    unsigned char *at = head + LWS_PRE, *const end = head + sizeof head;
    unsigned char* const begin = at;
    if (lws_add_http_common_headers(socket, HTTP_STATUS_OK, "text/html; charset=utf-8",
                                    pageText().size(), &at, end) != 0 ||
        // In a stranger's frame clicks would be meant for something else.
        addHeader(socket, "x-frame-options:", "DENY", &at, end) != 0 ||
        addHeader(socket, "content-security-policy:", "frame-ancestors 'none'", &at, end) != 0 ||
        lws_finalize_write_http_header(socket, begin, &at, end) != 0)
      return 1;
    *sent = 0;
    lws_callback_on_writable(socket);
    return 0;
  }

  static int httpBody(lws* socket, size_t* sent) {
    const std::string_view page = pageText();
    const size_t size = std::min(kHttpPiece, page.size() - *sent);
    std::vector<unsigned char> piece(LWS_PRE + size);
    std::memcpy(piece.data() + LWS_PRE, page.data() + *sent, size);
    const bool last = *sent + size == page.size();
    if (lws_write(socket, piece.data() + LWS_PRE, size,
                  last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) != static_cast<int>(size))
      return 1;
    *sent += size;
    if (!last) {
      lws_callback_on_writable(socket);
      return 0;
    }
    return lws_http_transaction_completed(socket) != 0 ? -1 : 0;
  }

  Client* find(lws* socket) {
    for (Client& client : clients)
      if (client.socket == socket) return &client;
    return nullptr;
  }

  void open(lws* socket) {
    clients.emplace_back();
    Client& client = clients.back();
    client.socket = socket;
    client.number = ++numbers;
    // Only our own page operates the robot; another site's, with the token, may look.
    client.may_command =
        server.settings_.may_command && isOurs(visitorOf(socket), server.settings_);
    client.pushText(serverInfo("tread-view", client.may_command || server.feed_.hasLog(),
                               server.feed_.hasLog(), server.session_));
    client.frames.push({{kText, 0}, 0, server.advertisement_, false});
    if (!server.words_.empty()) client.frames.pushNewest({kWords, 0});
  }

  void close(lws* socket) {
    for (auto client = clients.begin(); client != clients.end(); ++client)
      if (client->socket == socket) {
        server.leave_(client->number);
        clients.erase(client);
        return;
      }
  }

  int receive(lws* socket, void* in, size_t size) {
    Client* const client = find(socket);
    if (client == nullptr) return -1;
    client->received.append(static_cast<const char*>(in), size);
    if (client->received.size() > kLargestRequest) return -1;
    if (lws_is_final_fragment(socket) == 0 || lws_remaining_packet_payload(socket) > 0) return 0;
    const std::string text = std::move(client->received);
    client->received.clear();
    client->requests.use(static_cast<double>(std::max(kLeastRequest, text.size())));
    if (client->requests.left() < 0.0) return refuse(socket, "too many requests");
    server.receive(*client, text, lws_frame_is_binary(socket) != 0);
    return 0;
  }

  static int refuse(lws* socket, std::string why) {
    lws_close_reason(socket, LWS_CLOSE_STATUS_POLICY_VIOLATION,
                     reinterpret_cast<unsigned char*>(why.data()), why.size());
    return -1;
  }

  /// It does not wait for others.
  bool operates(const Client& client) const { return client.number == server.operator_; }

  /// Says whose turn it is: who operates the robot, and of the others as many as the line and the
  /// processor have room for, one after the other.
  void giveTurns() {
    double left = sends.left();
    const size_t count = clients.size();
    auto client = clients.begin();
    for (size_t i = 0; i < count; ++i) {
      const auto next = std::next(client);
      if (!client->asked && !client->frames.empty() && (operates(*client) || left > 0.0)) {
        client->asked = true;
        lws_callback_on_writable(client->socket);
        if (!operates(*client)) left -= kPiece;
        clients.splice(clients.end(), clients, client);
      }
      client = next;
    }
  }

  /// What goes over the line for a frame that waited; empty = nothing any more.
  std::string bytesOf(const Client& client, const Frame& frame) {
    const auto& [channel, part] = frame.part;
    if (channel == kText) return *frame.payload;
    if (channel == kWords) return statusMessage(0, server.words_);
    if (channel == kTime) return timeFrame(server.feed_.now());
    const auto subscription = client.subscriptions.find(channel);
    if (subscription == client.subscriptions.end()) return "";
    if (frame.payload) return messageFrame(subscription->second, frame.time, *frame.payload);
    const std::optional<FeedMessage> newest = server.feed_.newest(channel, part);
    return newest ? messageFrame(subscription->second, newest->time, *newest->payload) : "";
  }

  int write(lws* socket) {
    Client* const client = find(socket);
    if (client == nullptr) return 0;
    client->asked = false;
    for (size_t sent = 0; !client->frames.empty() && sent < kPiece;) {
      const Frame frame = client->frames.pop();
      const std::string bytes = bytesOf(*client, frame);
      if (bytes.empty()) continue;
      const bool text = frame.part.first == kText || frame.part.first == kWords;
      buffer.resize(LWS_PRE + bytes.size());
      std::memcpy(buffer.data() + LWS_PRE, bytes.data(), bytes.size());
      const int written = lws_write(socket, buffer.data() + LWS_PRE, bytes.size(),
                                    text ? LWS_WRITE_TEXT : LWS_WRITE_BINARY);
      if (written < static_cast<int>(bytes.size())) return -1;
      sent += bytes.size();
      if (!operates(*client)) sends.use(static_cast<double>(bytes.size()));
      if (lws_send_pipe_choked(socket) != 0) break;
    }
    return 0;
  }

  ViewServer& server;
  std::vector<lws_protocols> protocols;
  lws_context* context = nullptr;
  std::list<Client> clients;
  uint64_t numbers = 0;
  std::vector<unsigned char> buffer;
  Allowance accepts{kAcceptRate, kAcceptBurst};
  Allowance sends{kSendRate, kSendBurst};
};

ViewServer::ViewServer(const ServerSettings& settings, Command command, Leave leave)
    : settings_(settings),
      command_(std::move(command)),
      leave_(std::move(leave)),
      session_(std::to_string(std::chrono::system_clock::now().time_since_epoch().count())),
      advertisement_(std::make_shared<const std::string>(advertisement(OfferedChannels()))),
      feed_([this](uint32_t channel) { return wanted(channel); },
            [this](const FeedMessage& message) { send(message); }),
      sockets_(std::make_unique<Sockets>(*this)) {
  lws_set_log_level(0, nullptr);
  // Without a subprotocol it is a browser that asks for the page.
  sockets_->protocols.push_back({"http", &Sockets::called, sizeof(size_t), 0, 0, nullptr, 0});
  for (const char* name : kSubprotocols)
    sockets_->protocols.push_back({name, &Sockets::called, 0, kReceiveBuffer, 0, nullptr, 0});
  sockets_->protocols.push_back({nullptr, nullptr, 0, 0, 0, nullptr, 0});
  lws_context_creation_info info{};
  info.port = settings_.port;
  info.iface = settings_.address.empty() ? nullptr : settings_.address.c_str();
  info.protocols = sockets_->protocols.data();
  info.user = sockets_.get();
  info.gid = info.uid = static_cast<decltype(info.gid)>(-1);
  info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
  if (!settings_.certificate.empty()) {
    info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
    info.ssl_cert_filepath = info.ssl_private_key_filepath = settings_.certificate.c_str();
  }
  sockets_->context = lws_create_context(&info);
  lws_vhost* const host =
      sockets_->context == nullptr ? nullptr : lws_create_vhost(sockets_->context, &info);
  port_ = host == nullptr ? -1 : lws_get_vhost_listen_port(host);
  if (port_ <= 0) {
    if (sockets_->context != nullptr) lws_context_destroy(sockets_->context);
    throw std::runtime_error(settings_.address + ":" + std::to_string(settings_.port) +
                             " cannot be listened at; is it taken (--port)?");
  }
}

ViewServer::~ViewServer() {
  lws_context_destroy(sockets_->context);
}

void ViewServer::step(double elapsed) {
  feed_.step(elapsed);
  if (feed_.hasLog() && feed_.now() != told_time_) {
    told_time_ = feed_.now();
    for (Client& client : sockets_->clients) client.frames.pushNewest({kTime, 0});
  }
  // Where the processor is scarce and steps come late, viewers get less, and who operates does not
  // wait for them.
  const double granted = std::min(elapsed, kLongestStep);
  sockets_->accepts.wait(granted);
  sockets_->sends.wait(granted);
  for (Client& client : sockets_->clients) client.requests.wait(granted);
  sockets_->giveTurns();
  // Negative: without waiting. Each call serves what is ready; several requests may be waiting.
  for (int i = 0; i < 4; ++i) lws_service(sockets_->context, -1);
}

void ViewServer::tell(const std::string& words) {
  words_ = words;
  for (Client& client : sockets_->clients) client.frames.pushNewest({kWords, 0});
}

bool ViewServer::wanted(uint32_t channel) const {
  return sockets_ != nullptr &&
         std::any_of(sockets_->clients.begin(), sockets_->clients.end(),
                     [&](const Client& client) { return client.subscriptions.count(channel) > 0; });
}

void ViewServer::send(const FeedMessage& message) {
  if (sockets_ == nullptr) return;
  for (Client& client : sockets_->clients)
    if (client.subscriptions.count(message.channel) > 0)
      client.frames.push(
          {{message.channel, message.part}, message.time, message.payload, message.is_news});
}

void ViewServer::receive(Client& client, const std::string& text, bool binary) {
  if (!binary) return serve(client, readRequest(text));
  uint32_t channel = 0;
  std::string payload;
  if (!readClientFrame(text, channel, payload)) return;
  const auto topic = client.topics.find(channel);
  if (topic != client.topics.end()) control(client, topic->second, payload);
}

void ViewServer::serve(Client& client, const ClientRequest& request) {
  if (!request.problem.empty()) client.pushText(statusMessage(1, request.problem));
  for (const auto& [subscription, channel] : request.subscribe) {
    if (channel == 0 || channel > feed_.channels().all().size()) {
      client.pushText(statusMessage(1, "there is no channel " + std::to_string(channel)));
      continue;
    }
    // Once more is the same subscription by another name.
    const bool first = client.subscriptions.count(channel) == 0;
    client.subscriptions[channel] = subscription;
    if (!first) continue;
    for (const uint64_t part : feed_.partsOf(channel)) client.frames.pushNewest({channel, part});
  }
  for (const uint32_t subscription : request.unsubscribe)
    for (auto entry = client.subscriptions.begin(); entry != client.subscriptions.end();)
      entry = entry->second == subscription ? client.subscriptions.erase(entry) : std::next(entry);
  for (const auto& [id, topic] : request.advertise)
    if (client.topics.size() < kMostTopics || client.topics.count(id) > 0)
      client.topics[id] = topic.substr(0, kLongestTopic);
  for (const uint32_t id : request.unadvertise) client.topics.erase(id);
}

void ViewServer::control(Client& client, const std::string& topic, const std::string& payload) {
  std::string problem;
  if (topic == kCommandTopic) {
    problem = client.may_command ? command_(payload, client.number)
                                 : "this page may look, but not operate the robot";
  } else if (topic == kControlTopic) {
    try {
      const Json json = Json::parse(payload);
      const auto op = json.at("op").get<std::string>();
      if (op == "seek")
        feed_.seek(json.at("time").get<int64_t>(), json.value("request", int64_t{0}));
      if (op == "play") feed_.play(true, json.value("speed", 1.0));
      if (op == "pause") feed_.play(false, json.value("speed", 1.0));
    } catch (const Json::exception&) {
      problem = "a control that cannot be read was passed over";
    }
  } else {
    problem = "nobody listens to " + topic + " here";
  }
  if (!problem.empty()) client.pushText(statusMessage(1, problem));
}

}  // namespace tread::view
