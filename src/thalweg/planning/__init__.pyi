from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import Proof
from thalweg.planning.planner import plan
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.voyage import Voyage

__all__ = ["NetworkChoice", "Plan", "Proof", "Voyage", "plan"]
