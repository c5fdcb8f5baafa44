#pragma once

#include <memory>
#include <string>

#include "drivers/bus_documents.h"

namespace flinch {

/// A private key and the certificate that goes with it, as PEM.
struct Credential {
  std::string private_key;
  std::string certificate;
  std::string subject;  ///< of the certificate, as RFC 2253 writes it
};

/// Somebody whose signature counts. Its private key exists only in here, and is gone with it. Elliptic curve
/// P-256, SHA-256.
class KeyAuthority {
 public:
  /// Throws SetupError where libcrypto fails, as all here do.
  KeyAuthority(const std::string& name, const KeyValidity& validity);
  ~KeyAuthority();

  /// By which its signatures are verified, as PEM.
  const std::string& certificate() const noexcept;

  /// A new private key, and a certificate that it belongs to `name`.
  Credential issue(const std::string& name) const;

  /// `text` with a signature, as an S/MIME message.
  std::string sign(const std::string& text) const;

 private:
  class Implementation;
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace flinch
