from thalweg.planning.indicators.alternative_plans import AlternativePlans, alternative_plans
from thalweg.planning.indicators.front_of_voyage import indicator_front
from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import Proof
from thalweg.planning.planner import plan
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.voyage import Voyage

__all__ = [
    "AlternativePlans",
    "NetworkChoice",
    "Plan",
    "Proof",
    "Voyage",
    "alternative_plans",
    "indicator_front",
    "plan",
]
