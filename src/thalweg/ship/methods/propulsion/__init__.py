"""Propulsion: propeller series, wake, thrust deduction, efficiencies."""
