#include "drivers/key_authority.h"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

struct Free {
  void operator()(BIO* it) const { BIO_free(it); }
  void operator()(BIGNUM* it) const { BN_free(it); }
  void operator()(EVP_PKEY* it) const { EVP_PKEY_free(it); }
  void operator()(PKCS7* it) const { PKCS7_free(it); }
  void operator()(X509* it) const { X509_free(it); }
  void operator()(X509_EXTENSION* it) const { X509_EXTENSION_free(it); }
  void operator()(X509_NAME* it) const { X509_NAME_free(it); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

/// Throws SetupError if a call of libcrypto has failed.
void require(bool good) {
  if (good) return;
  const char* const reason = ERR_reason_error_string(ERR_get_error());
  throw SetupError(std::string("libcrypto could not make a key: ") +
                   (reason != nullptr ? reason : "unknown"));
}

template <class T>
Owned<T> owned(T* made) {
  require(made != nullptr);
  return Owned<T>(made);
}

Owned<BIO> memory() { return owned(BIO_new(BIO_s_mem())); }

std::string text_of(BIO& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(&bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

std::string pem(X509& certificate) {
  const Owned<BIO> bio = memory();
  require(PEM_write_bio_X509(bio.get(), &certificate) == 1);
  return text_of(*bio);
}

std::string pem(EVP_PKEY& key) {
  const Owned<BIO> bio = memory();
  require(PEM_write_bio_PrivateKey(bio.get(), &key, nullptr, nullptr, 0, nullptr, nullptr) == 1);
  return text_of(*bio);
}

std::string rfc2253(X509& certificate) {
  const Owned<BIO> bio = memory();
  require(X509_NAME_print_ex(bio.get(), X509_get_subject_name(&certificate), 0, XN_FLAG_RFC2253) >= 0);
  return text_of(*bio);
}

Owned<X509_NAME> subject(const std::string& name) {
  Owned<X509_NAME> subject = owned(X509_NAME_new());
  const auto* const bytes = reinterpret_cast<const unsigned char*>(name.c_str());
  require(X509_NAME_add_entry_by_txt(subject.get(), "CN", MBSTRING_UTF8, bytes, -1, -1, 0) == 1);
  return subject;
}

/// 127 bits from the random generator.
void draw_serial_number(X509& certificate) {
  const Owned<BIGNUM> number = owned(BN_new());
  require(BN_rand(number.get(), 127, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1);
  require(BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(&certificate)) != nullptr);
}

void add_extension(X509& certificate, X509V3_CTX& context, int kind, const char* value) {
  const Owned<X509_EXTENSION> extension = owned(X509V3_EXT_conf_nid(nullptr, &context, kind, value));
  require(X509_add_ext(&certificate, extension.get(), -1) == 1);
}

/// Who signs: for the authority's own certificate there is no other yet.
struct Signer {
  EVP_PKEY* key;
  X509* certificate;
};

Owned<X509> certify(EVP_PKEY& key, const std::string& name, const KeyValidity& validity,
                    const Signer& signer) {
  Owned<X509> made = owned(X509_new());
  X509& certificate = *made;
  const bool is_authority = signer.certificate == nullptr;
  X509* const issuer = is_authority ? &certificate : signer.certificate;
  const Owned<X509_NAME> its_name = subject(name);
  draw_serial_number(certificate);
  require(X509_set_version(&certificate, X509_VERSION_3) == 1);
  require(ASN1_TIME_set(X509_getm_notBefore(&certificate), validity.from) != nullptr);
  require(ASN1_TIME_set(X509_getm_notAfter(&certificate), validity.to) != nullptr);
  require(X509_set_subject_name(&certificate, its_name.get()) == 1);
  require(X509_set_issuer_name(&certificate, X509_get_subject_name(issuer)) == 1);
  require(X509_set_pubkey(&certificate, &key) == 1);

  X509V3_CTX context{};
  X509V3_set_ctx(&context, issuer, &certificate, nullptr, nullptr, 0);
  add_extension(certificate, context, NID_basic_constraints,
                is_authority ? "critical,CA:TRUE,pathlen:0" : "critical,CA:FALSE");
  add_extension(certificate, context, NID_key_usage,
                is_authority ? "critical,keyCertSign,digitalSignature" : "critical,digitalSignature");
  add_extension(certificate, context, NID_subject_key_identifier, "hash");
  add_extension(certificate, context, NID_authority_key_identifier, "keyid:always");
  require(X509_sign(&certificate, signer.key, EVP_sha256()) > 0);
  return made;
}

Owned<EVP_PKEY> new_key() { return owned(EVP_EC_gen("P-256")); }

}  // namespace

class KeyAuthority::Implementation {
 public:
  Implementation(const std::string& name, const KeyValidity& validity)
      : validity_(validity),
        key_(new_key()),
        certificate_(certify(*key_, name, validity, {key_.get(), nullptr})),
        pem_(pem(*certificate_)) {}

  const std::string& certificate() const noexcept { return pem_; }

  Credential issue(const std::string& name) const {
    const Owned<EVP_PKEY> key = new_key();
    const Owned<X509> certificate = certify(*key, name, validity_, {key_.get(), certificate_.get()});
    return {.private_key = pem(*key), .certificate = pem(*certificate), .subject = rfc2253(*certificate)};
  }

  std::string sign(const std::string& text) const {
    constexpr int flags = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
    const Owned<BIO> in = owned(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
    const Owned<BIO> out = memory();
    const Owned<PKCS7> signature =
        owned(PKCS7_sign(certificate_.get(), key_.get(), nullptr, in.get(), flags));
    require(SMIME_write_PKCS7(out.get(), signature.get(), in.get(), flags) == 1);
    return text_of(*out);
  }

 private:
  KeyValidity validity_;
  Owned<EVP_PKEY> key_;
  Owned<X509> certificate_;
  std::string pem_;
};

KeyAuthority::KeyAuthority(const std::string& name, const KeyValidity& validity)
    : implementation_(std::make_unique<const Implementation>(name, validity)) {}

KeyAuthority::~KeyAuthority() = default;

const std::string& KeyAuthority::certificate() const noexcept { return implementation_->certificate(); }
Credential KeyAuthority::issue(const std::string& name) const { return implementation_->issue(name); }
std::string KeyAuthority::sign(const std::string& text) const { return implementation_->sign(text); }

}  // namespace flinch
