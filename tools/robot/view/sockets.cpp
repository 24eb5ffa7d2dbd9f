// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/sockets.hpp"

#include <libwebsockets.h>
#include <sys/socket.h>

#include <cstring>
#include <ctime>
#include <stdexcept>

#include "tools/robot/view/feed/protocol.hpp"
#include "tools/robot/view/http_page.hpp"

namespace tread::view {
namespace {

constexpr size_t kReceiveBuffer = 4096;         // [bytes]
constexpr int kMostWaiting = 64;                // connections waiting in the kernel
constexpr unsigned int kHandshakeSeconds = 10;  // [s] limit before a WebSocket is open

/// Processor time of this thread so far [s].
double computedSoFar() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

int refuse(lws* socket, std::string why) {
  lws_close_reason(socket, LWS_CLOSE_STATUS_POLICY_VIOLATION,
                   reinterpret_cast<unsigned char*>(why.data()), why.size());
  return -1;
}

}  // namespace

/// Callbacks of libwebsockets.
struct Sockets::Library {
  Library(const ServerSettings& settings, Sockets& owner);
  ~Library() {
    if (context != nullptr) lws_context_destroy(context);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  static int called(lws* socket, lws_callback_reasons reason, void* user, void* in, size_t size) {
    auto* const sockets = static_cast<Sockets*>(lws_context_user(lws_get_context(socket)));
    // Exceptions must not cross C code.
    try {
      return sockets == nullptr ? 0 : handle(*sockets, socket, reason, user, in, size);
    } catch (const std::exception&) {
      return -1;
    }
  }

  static int handle(Sockets& sockets, lws* socket, lws_callback_reasons reason, void* user,
                    void* in, size_t size) {
    switch (reason) {
      case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:
        sockets.accept(socket);
        return 0;
      case LWS_CALLBACK_HTTP:
        return answerRequest(socket, sockets.settings_, static_cast<size_t*>(user));
      case LWS_CALLBACK_HTTP_WRITEABLE:
        return continuePage(socket, static_cast<size_t*>(user));
      case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return mayLook(visitorOf(socket), sockets.settings_) && sockets.hasRoom(socket) ? 0 : -1;
      case LWS_CALLBACK_ESTABLISHED:
        sockets.open(socket);
        return 0;
      case LWS_CALLBACK_CLOSED:
        sockets.close(socket);
        return 0;
      case LWS_CALLBACK_RECEIVE:
        return sockets.receive(socket, static_cast<const char*>(in), size);
      case LWS_CALLBACK_SERVER_WRITEABLE:
        return sockets.write(socket);
      default:
        return 0;
    }
  }

  std::vector<lws_protocols> protocols;
  lws_context* context = nullptr;
  int port = -1;
};

Sockets::Library::Library(const ServerSettings& settings, Sockets& owner) {
  lws_set_log_level(0, nullptr);
  // Without a subprotocol it is a browser's request for the page.
  protocols.push_back({"http", &Library::called, sizeof(size_t), 0, 0, nullptr, 0});
  for (const char* name : kSubprotocols)
    protocols.push_back({name, &Library::called, 0, kReceiveBuffer, 0, nullptr, 0});
  protocols.push_back({nullptr, nullptr, 0, 0, 0, nullptr, 0});
  lws_context_creation_info info{};
  info.port = settings.port;
  info.iface = settings.address.empty() ? nullptr : settings.address.c_str();
  info.protocols = protocols.data();
  info.user = &owner;
  info.gid = info.uid = static_cast<decltype(info.gid)>(-1);
  info.timeout_secs = kHandshakeSeconds;
  info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
  if (!settings.certificate.empty()) {
    info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
    info.ssl_cert_filepath = info.ssl_private_key_filepath = settings.certificate.c_str();
  }
  context = lws_create_context(&info);
  lws_vhost* const host = context == nullptr ? nullptr : lws_create_vhost(context, &info);
  port = host == nullptr ? -1 : lws_get_vhost_listen_port(host);
}

Sockets::Sockets(const ServerSettings& settings, SocketEvents events)
    : settings_(settings),
      events_(std::move(events)),
      library_(std::make_unique<Library>(settings_, *this)) {
  if (library_->port <= 0)
    throw std::runtime_error(settings_.address + ":" + std::to_string(settings_.port) +
                             " is not available for listening; is it in use (--port)?");
}

Sockets::~Sockets() = default;

int Sockets::port() const {
  return library_->port;
}

void Sockets::step(double elapsed, uint64_t operates, bool limited) {
  const double before = computedSoFar();
  operator_ = operates;
  limits_.wait(elapsed);
  for (Client& client : clients_) client.requests.wait(elapsed);
  if (limits_.mayAccept()) listenAgain();
  holdOthers();
  giveTurns();
  // Negative: do not wait. Each call serves what is ready; several requests may be pending.
  for (int i = 0; i < 4; ++i) lws_service(library_->context, -1);
  if (limited) limits_.computed(computedSoFar() - before);
}

/// Programs that occupy all places must not keep the operator's page out.
bool Sockets::hasRoom(lws* socket) const {
  const Visitor visitor = visitorOf(socket);
  const bool page = isOurs(visitor, settings_) && !visitor.origin.empty();
  return clients_.size() < (page ? kMostPages : kMostClients);
}

/// Accepting and closing connections at once would only make clients retry: beyond the limit they
/// wait in the kernel at no cost.
void Sockets::accept(lws* listener) {
  limits_.accepted();
  if (limits_.mayAccept()) return;
  listener_ = listener;
  lws_rx_flow_control(listener, 0);
  // Beyond this backlog the kernel makes clients retry, which is faster than a long queue.
  ::listen(lws_get_socket_fd(listener), kMostWaiting);
}

void Sockets::listenAgain() {
  if (listener_ != nullptr) lws_rx_flow_control(listener_, 1);
  listener_ = nullptr;
}

Client* Sockets::find(lws* socket) {
  for (Client& client : clients_)
    if (client.socket == socket) return &client;
  return nullptr;
}

void Sockets::open(lws* socket) {
  clients_.emplace_back();
  Client& client = clients_.back();
  client.socket = socket;
  client.number = ++numbers_;
  // Only our own page operates the robot; a page of another site that has the token may only watch.
  client.may_command = settings_.may_command && isOurs(visitorOf(socket), settings_);
  events_.opened(client);
}

void Sockets::close(lws* socket) {
  for (auto client = clients_.begin(); client != clients_.end(); ++client)
    if (client->socket == socket) {
      events_.closed(*client);
      clients_.erase(client);
      return;
    }
}

int Sockets::receive(lws* socket, const char* bytes, size_t size) {
  Client* const client = find(socket);
  if (client == nullptr) return -1;
  client->received.append(bytes, size);
  if (client->received.size() > kLargestRequest) return -1;
  if (lws_is_final_fragment(socket) == 0 || lws_remaining_packet_payload(socket) > 0) return 0;
  const std::string text = std::move(client->received);
  client->received.clear();
  client->requests.use(static_cast<double>(std::max(kLeastRequest, text.size())));
  if (client->requests.left() < 0.0) return refuse(socket, "too many requests");
  events_.received(*client, text, lws_frame_is_binary(socket) != 0);
  return 0;
}

/// Beyond the limit only the operator is read; other requests wait at the client.
void Sockets::holdOthers() {
  for (Client& client : clients_) {
    const bool hold = !limits_.mayCompute() && !operates(client);
    if (hold != client.held) lws_rx_flow_control(client.socket, hold ? 0 : 1);
    client.held = hold;
  }
}

/// Schedules sending: the operator first, then the others in turn, as far as line and processor
/// allow.
void Sockets::giveTurns() {
  double left = limits_.sends();
  const size_t count = clients_.size();
  auto client = clients_.begin();
  for (size_t i = 0; i < count; ++i) {
    const auto next = std::next(client);
    if (!client->asked && !client->frames.empty() && (operates(*client) || left > 0.0)) {
      client->asked = true;
      lws_callback_on_writable(client->socket);
      if (!operates(*client)) left -= kPiece;
      clients_.splice(clients_.end(), clients_, client);
    }
    client = next;
  }
}

int Sockets::write(lws* socket) {
  Client* const client = find(socket);
  // libwebsockets also calls by itself, outside of this client's turn.
  if (client == nullptr || !client->asked) return 0;
  client->asked = false;
  for (size_t sent = 0; !client->frames.empty() && sent < kPiece;) {
    const auto [bytes, text] = events_.bytesOf(*client, client->frames.pop());
    if (bytes.empty()) continue;
    buffer_.resize(LWS_PRE + bytes.size());
    std::memcpy(buffer_.data() + LWS_PRE, bytes.data(), bytes.size());
    const int written = lws_write(socket, buffer_.data() + LWS_PRE, bytes.size(),
                                  text ? LWS_WRITE_TEXT : LWS_WRITE_BINARY);
    if (written < static_cast<int>(bytes.size())) return -1;
    sent += bytes.size();
    if (!operates(*client)) limits_.sent(bytes.size());
    if (lws_send_pipe_choked(socket) != 0) break;
  }
  return 0;
}

}  // namespace tread::view
