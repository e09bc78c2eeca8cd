//! Problems with known digits and closed forms.
