// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names of enum variants, the same in the command, in JSON and in every binding.

/// Gives an enum without data its names: `ALL`, `NAMES`, `name`, `Display` and `FromStr`. Reading a name ignores case; what
/// is no name is an [`InvalidOption`](crate::Error::InvalidOption) of the given [`Setting`](crate::error::Setting) that
/// lists the names.
macro_rules! named {
    ($type:ident of $setting:ident { $($variant:ident = $name:literal),+ $(,)? }) => {
        impl $type {
            /// Every variant, in the order of declaration.
            pub const ALL: [$type; [$($name),+].len()] = [$($type::$variant),+];
            /// The variants' names, in the same order.
            pub const NAMES: [&'static str; [$($name),+].len()] = [$($name),+];

            /// The variant's name, as [`FromStr`](std::str::FromStr) reads it.
            pub const fn name(self) -> &'static str {
                match self {
                    $($type::$variant => $name),+
                }
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $type {
            type Err = $crate::error::Error;

            fn from_str(text: &str) -> $crate::error::Result<Self> {
                $crate::names::find(&Self::NAMES, text).map(|at| Self::ALL[at]).ok_or_else(|| {
                    let setting = $crate::error::Setting::$setting;
                    $crate::error::Error::option(setting, text, $crate::settings::list(&Self::NAMES))
                })
            }
        }
    };
}
pub(crate) use named;

/// Where `name` stands in `names`, in any case.
pub(crate) fn find(names: &[&str], name: &str) -> Option<usize> {
    names.iter().position(|known| known.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Fruit {
        Apple,
        Pear,
    }
    named!(Fruit of Layer { Apple = "apple", Pear = "pear" });

    #[test]
    fn names_go_there_and_back_and_others_are_refused_with_the_list() {
        for fruit in Fruit::ALL {
            assert_eq!(fruit.to_string().parse::<Fruit>().unwrap(), fruit);
            assert_eq!(fruit.name().to_uppercase().parse::<Fruit>().unwrap(), fruit);
        }
        assert_eq!(format!("{:>6}|", Fruit::Pear), "  pear|");
        let error = "plum".parse::<Fruit>().unwrap_err().to_string();
        assert_eq!(error, "layer: `plum` is not allowed; it may be apple or pear");
    }
}
