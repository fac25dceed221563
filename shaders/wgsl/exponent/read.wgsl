// An exponent that is read, as if the shader served all power kernels.

#import core::kernel_read::kernel_read

fn exponent() -> u32 {
    return kernel_read.exponent;
}
