//! What of a machine decides the bits of what is computed on it, a solver's own back-end aside.

/// System, processor and the instructions that Fourier transforms and the system's mathematics choose at run
/// time, such as `linux x86_64 avx`. Where it is the same, the same program gives the same bits; turbulence
/// that is made elsewhere may differ in its last digits.
pub fn numerics() -> String {
    format!("{} {} {}", std::env::consts::OS, std::env::consts::ARCH, instructions())
}

/// The set that RustFFT takes, and with it the C library's functions.
#[cfg(target_arch = "x86_64")]
fn instructions() -> &'static str {
    if is_x86_feature_detected!("avx") && is_x86_feature_detected!("fma") {
        "avx"
    } else if is_x86_feature_detected!("sse4.1") {
        "sse4.1"
    } else {
        "scalar"
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn instructions() -> &'static str {
    "scalar"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn system_and_processor_are_named() {
        let told = numerics();
        assert_eq!(told.split(' ').count(), 3, "{told}");
        assert!(told.contains(std::env::consts::ARCH), "{told}");
        assert_eq!(told, numerics());
    }
}
