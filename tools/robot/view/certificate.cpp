// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/certificate.hpp"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "common/seal/private_file.hpp"

namespace tread::view {
namespace {

template <class Type, void (*release)(Type*)>
struct Releases {
  void operator()(Type* object) const { release(object); }
};
using Key = std::unique_ptr<EVP_PKEY, Releases<EVP_PKEY, EVP_PKEY_free>>;
using X509Pointer = std::unique_ptr<X509, Releases<X509, X509_free>>;
using Bio = std::unique_ptr<BIO, Releases<BIO, BIO_free_all>>;

void require(bool done) {
  if (!done) throw std::runtime_error("OpenSSL cannot make a certificate for this machine");
}

std::string hostName() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 && name[0] != '\0' ? name : "robot";
}

void addExtension(X509& certificate, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &certificate, &certificate, nullptr, nullptr, 0);
  X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str());
  require(extension != nullptr);
  const bool added = X509_add_ext(&certificate, extension, -1) == 1;
  X509_EXTENSION_free(extension);
  require(added);
}

/// Unlimited validity: a robot without a network may have the date of 1970.
X509Pointer certify(EVP_PKEY& key) {
  X509Pointer certificate(X509_new());
  require(certificate != nullptr);
  X509& made = *certificate;
  uint64_t serial = 0;
  require(RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) == 1);
  const std::string name = hostName();
  X509_NAME* const subject = X509_get_subject_name(&made);
  require(X509_set_version(&made, 2) == 1 &&
          ASN1_INTEGER_set_uint64(X509_get_serialNumber(&made), serial >> 1) == 1 &&
          ASN1_TIME_set_string_X509(X509_getm_notBefore(&made), "19700101000000Z") == 1 &&
          ASN1_TIME_set_string_X509(X509_getm_notAfter(&made), "20491231235959Z") == 1 &&
          X509_NAME_add_entry_by_txt(subject, "O", MBSTRING_UTF8,
                                     reinterpret_cast<const unsigned char*>("tread-view"), -1, -1,
                                     0) == 1 &&
          X509_NAME_add_entry_by_txt(
              subject, "CN", MBSTRING_UTF8,
              reinterpret_cast<const unsigned char*>(name.substr(0, 64).c_str()), -1, -1, 0) == 1 &&
          X509_set_issuer_name(&made, subject) == 1 && X509_set_pubkey(&made, &key) == 1);
  addExtension(made, NID_subject_alt_name, "DNS:" + name + ",DNS:localhost,IP:127.0.0.1");
  addExtension(made, NID_basic_constraints, "critical,CA:FALSE");
  require(X509_sign(&made, &key, EVP_sha256()) > 0);
  return certificate;
}

std::string newPem() {
  const Key key(EVP_EC_gen("P-256"));
  require(key != nullptr);
  const X509Pointer certificate = certify(*key);
  const Bio text(BIO_new(BIO_s_mem()));
  require(text != nullptr && PEM_write_bio_X509(text.get(), certificate.get()) == 1 &&
          PEM_write_bio_PrivateKey(text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) ==
              1);
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(text.get(), &bytes);
  return {bytes, static_cast<size_t>(size)};
}

/// Empty if the text holds no certificate or not its key.
std::string fingerprintOf(const std::string& pem) {
  const Bio text(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  const X509Pointer certificate(PEM_read_bio_X509(text.get(), nullptr, nullptr, nullptr));
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  const Key key(PEM_read_bio_PrivateKey(text.get(), nullptr, nullptr, nullptr));
  if (!certificate || !key || X509_digest(certificate.get(), EVP_sha256(), digest, &size) != 1)
    return "";
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string words;
  for (unsigned int i = 0; i < size; ++i) {
    if (i > 0) words += ':';
    words += kDigits[digest[i] >> 4];
    words += kDigits[digest[i] & 15];
  }
  return words;
}

}  // namespace

Certificate ownCertificate(const std::string& folder) {
  std::error_code none;
  std::filesystem::create_directories(folder, none);
  const PrivateFile file{"certificate", folder + "/certificate.pem",
                         "remove it, so that another one is made"};
  Certificate certificate{file.path, "", !file.isThere() && file.ensure(newPem())};
  certificate.fingerprint = fingerprintOf(file.read());
  if (certificate.fingerprint.empty())
    file.refuse("does not contain a certificate and its key",
                "remove it, so that another one is made");
  return certificate;
}

}  // namespace tread::view
